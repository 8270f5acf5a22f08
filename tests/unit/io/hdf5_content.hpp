// The bytes of an HDF5 file without a seal, as other programs write it.
#pragma once

#include "sealed_file.hpp"
#include "unit/files/disk.hpp"

#include <functional>
#include <vector>

namespace keeler::test {

inline std::vector<std::byte> hdf5_content(const std::function<void(const io::hdf5::Handle&)>& fill) {
  const TemporaryFolder folder;
  io::SealedFile out(folder / "a.h5");
  out.write(fill);
  out.finish();
  std::vector<std::byte> content = io::load_content(folder / "a.h5").bytes;
  return content;
}

} // namespace keeler::test
