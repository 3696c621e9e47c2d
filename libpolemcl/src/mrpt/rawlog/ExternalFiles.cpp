#include "mrpt/rawlog/ExternalFiles.h"

#include <mrpt/io/lazy_load_path.h>

#include <filesystem>

namespace polemcl {

void findExternals(const std::string& rawlog) {
  const std::filesystem::path file = std::filesystem::absolute(rawlog);
  const std::filesystem::path images = file.parent_path() / (file.stem().string() + "_Images");
  std::error_code none;
  mrpt::io::setLazyLoadPathBase(
      (std::filesystem::is_directory(images, none) ? images : file.parent_path()).string());
}

}  // namespace polemcl
