#include "config/PlainText.h"

#include <algorithm>

#include <polemcl/core/common/Types.h>
#include "io/file/ReadLimits.h"

namespace polemcl {

void requirePlain(const std::string& text, const std::string& name) {
  std::size_t number = 0, references = 0, longest = 0;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
    end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const std::string where = name + ":" + std::to_string(++number) + ": ";
    for (auto at = line.find('$'); at != std::string::npos; at = line.find('$', at + 1)) {
      const char next = at + 1 < line.size() ? line[at + 1] : ' ';
      if (next == 'e' || next == '$' || next == '\\')
        throw Error(where + "$" + next +
                    ": neither $eval{} nor $env{} is allowed; write the value");
      references += next == '{';
    }
    if (line.find("@define") == std::string::npos) continue;
    longest = std::max(longest, line.size());
    if (line.find('$') != std::string::npos)
      throw Error(where + "@define may not use another: write its value");
  }
  if (text.size() + references * longest > io::mostInflated(text.size()))
    throw Error(name + ": what @define stands for is too long");
}

}  // namespace polemcl
