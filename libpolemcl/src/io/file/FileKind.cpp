#include "io/file/FileKind.h"

#include <map>

namespace polemcl::io {

std::string otherKind(const std::filesystem::path& file, const std::string& expected) {
  static const std::map<std::string, std::string> kinds{
      {".3Dscene", "a scene"},    {".csv", "a table"},         {".ini", "a file of settings"},
      {".json", "a JSON file"},   {".npz", "a NumPy archive"}, {".pcd", "a point cloud"},
      {".polemap", "a pole map"}, {".rawlog", "a rawlog"},     {".tum", "a trajectory (TUM)"}};
  const auto kind = kinds.find(file.extension().string());
  if (kind == kinds.end() || kind->first == expected) return {};
  return "it is " + kind->second + ", ";
}

}  // namespace polemcl::io
