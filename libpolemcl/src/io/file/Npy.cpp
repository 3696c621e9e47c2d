#include <charconv>
#include <limits>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"
#include "io/file/Npz.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace {

constexpr std::string_view magic("\x93NUMPY", 6);

/// Content of the dictionary in a `.npy` header.
struct Layout {
  bool isFloat64 = false;
  bool fortranOrder = false;
  std::vector<std::size_t> shape;
};

/// The text after `'key':` in a header dictionary.
std::string_view valueOf(std::string_view header, std::string_view key, const std::string& where) {
  const std::string quoted = "'" + std::string(key) + "':";
  const auto found = header.find(quoted);
  if (found == std::string_view::npos) {
    throw Error(where + "damaged: no " + std::string(key) + " in the .npy header");
  }
  return trimmed(header.substr(found + quoted.size()));
}

std::vector<std::size_t> parseShape(std::string_view text, const std::string& where) {
  const Error error(where + "damaged: the .npy header has no valid shape");
  const auto close = text.find(')');
  if (text.empty() || text.front() != '(' || close == std::string_view::npos) throw error;
  text = text.substr(1, close - 1);
  std::vector<std::size_t> shape;
  while (!trimmed(text).empty()) {
    const auto comma = text.find(',');
    const std::string_view word = trimmed(text.substr(0, comma));
    std::size_t size = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), size);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size()) throw error;
    shape.push_back(size);
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return shape;
}

Layout parseHeader(std::string_view header, const std::string& where) {
  Layout layout;
  const std::string_view type = valueOf(header, "descr", where);
  layout.isFloat64 = type.substr(0, 5) == "'<f8'";
  if (!layout.isFloat64 && type.substr(0, 5) != "'<f4'") {
    throw Error(where + "elements of type " + std::string(type.substr(0, type.find(','))) +
                "; '<f4' and '<f8' (little-endian float32, float64) are read");
  }
  const std::string_view order = valueOf(header, "fortran_order", where);
  layout.fortranOrder = order.substr(0, 4) == "True";
  if (!layout.fortranOrder && order.substr(0, 5) != "False") {
    throw Error(where + "damaged: fortran_order in the .npy header is neither True nor False");
  }
  layout.shape = parseShape(valueOf(header, "shape", where), where);
  return layout;
}

/// Number of elements; throws unless they fill the data exactly.
std::size_t countElements(const Layout& layout, std::size_t dataBytes, const std::string& where) {
  const std::size_t elementBytes = layout.isFloat64 ? 8 : 4;
  std::size_t count = 1;
  bool fits = true;
  for (const std::size_t size : layout.shape) {
    fits = fits && (size == 0 || count <= std::numeric_limits<std::size_t>::max() / size);
    count *= size;
  }
  if (!fits || dataBytes % elementBytes != 0 || count != dataBytes / elementBytes) {
    throw Error(where + "cut short or damaged: " + std::to_string(dataBytes) +
                " bytes of data do not fit its shape");
  }
  return count;
}

/// Index in C order of the element at `index` in Fortran order.
std::size_t toCOrder(std::size_t index, const std::vector<std::size_t>& shape) {
  std::size_t result = 0;
  std::size_t stride = 1;
  for (const std::size_t size : shape) stride *= size;
  for (const std::size_t size : shape) {
    stride /= size;
    result += index % size * stride;
    index /= size;
  }
  return result;
}

}  // namespace

NumberArray parseNpy(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where + "cut short: ");
  if (bytes.substr(0, magic.size()) != magic) throw Error(where + "not .npy data");
  reader.getRaw(magic.size());
  const int version = reader.getRaw(2).front();
  if (version < 1 || version > 3) {
    throw Error(where + "version " + std::to_string(version) + " of .npy; 1 to 3 are read");
  }
  const std::size_t headerSize =
      version == 1 ? reader.get<std::uint16_t>() : reader.get<std::uint32_t>();
  const Layout layout = parseHeader(reader.getRaw(headerSize), where);
  const std::size_t count = countElements(layout, reader.remaining(), where);
  const std::string_view data = reader.getRaw(reader.remaining());
  NumberArray array{layout.shape, std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const double value = layout.isFloat64 ? loadLittleEndian<double>(data.data() + 8 * i)
                                          : loadLittleEndian<float>(data.data() + 4 * i);
    array.values[layout.fortranOrder ? toCOrder(i, layout.shape) : i] = value;
  }
  return array;
}

}  // namespace polemcl::io
