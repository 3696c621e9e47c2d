#include "fuzz/Fuzz.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace polemcl::fuzz {

const std::filesystem::path& folder() {
  static const std::filesystem::path path = [] {
    std::string name = (std::filesystem::temp_directory_path() / "fuzz-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder: " + name);
    return name;
  }();
  return path;
}

std::filesystem::path fileOf(const std::string& name, std::string_view bytes) {
  std::filesystem::path path = folder() / name;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ::write(file, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("cannot write " + path.string());
  ::close(file);
  return path;
}

void readWithOne(const Readers& readers, std::string_view bytes) {
  if (bytes.empty()) return;
  readers[static_cast<unsigned char>(bytes.front()) % readers.size()](bytes.substr(1));
}

std::string inputFor(std::size_t reader, const std::string& rest) {
  return static_cast<char>(reader) + rest;
}

std::vector<std::string_view> pieces(std::string_view bytes, std::size_t most) {
  std::vector<std::string_view> found;
  while (found.size() + 1 < most) {
    const std::size_t end = bytes.find('\x1c');
    if (end == std::string_view::npos) break;
    found.push_back(bytes.substr(0, end));
    bytes.remove_prefix(end + 1);
  }
  found.push_back(bytes);
  return found;
}

std::string joined(const std::vector<std::string>& pieces) {
  std::string all;
  for (const std::string& piece : pieces) all += (&piece == pieces.data() ? "" : "\x1c") + piece;
  return all;
}

std::string made(const std::string& name) {
  const char* folder = std::getenv("POLEMCL_FUZZ_MADE");
  if (folder == nullptr) return {};
  std::ifstream stream(std::filesystem::path(folder) / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

unsigned Numbers::byte() {
  if (m_bytes.empty()) return 0;
  const auto value = static_cast<unsigned char>(m_bytes.front());
  m_bytes.remove_prefix(1);
  return value;
}

float Numbers::real() {
  float value = 0;
  std::memcpy(&value, m_bytes.data(), std::min(sizeof value, m_bytes.size()));
  m_bytes.remove_prefix(std::min(sizeof value, m_bytes.size()));
  return value;
}

}  // namespace polemcl::fuzz
