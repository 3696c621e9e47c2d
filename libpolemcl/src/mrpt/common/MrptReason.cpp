#include "mrpt/common/MrptReason.h"

namespace polemcl {

std::string mrptReason(const std::string& what) {
  const std::string innermost = "Original exception:", message = "Message:";
  std::size_t begin = what.rfind(innermost);
  begin = begin == std::string::npos ? 0 : begin + innermost.size();
  const std::size_t marked = what.find(message, begin);
  if (marked != std::string::npos) begin = marked + message.size();
  begin = what.find_first_not_of(" \n\t", begin);
  if (begin == std::string::npos) return what;
  return what.substr(begin, what.find('\n', begin) - begin);
}

}  // namespace polemcl
