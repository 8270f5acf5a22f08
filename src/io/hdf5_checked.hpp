// For hdf5*.cpp: the wrapper of each HDF5 call. The library's printing is off during the call, and a failure is
// converted to an IoError.
#pragma once

#include "hdf5.hpp"

#include <string>

namespace keeler::io::hdf5 {

/// Switches HDF5's error printing off during its lifetime.
class Quiet {
public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Throws IoError "cannot WHAT: reason of the last failure". Precondition: an HDF5 call failed.
[[noreturn]] void fail(const std::string& what);

/// Returns call(), and throws by fail() when the result is negative. `what` completes "cannot ...".
template<class Call> auto checked(const std::string& what, const Call& call) {
  const Quiet quiet;
  const auto result = call();
  if (result < 0)
    fail(what);
  return result;
}

/// Returns a name that no other open file has: HDF5 treats two files of equal name as one.
std::string fresh_name();

/// Throws std::bad_alloc unless `bytes` and a reserve for HDF5 itself can be allocated: HDF5 may crash when an
/// allocation fails.
void require_memory(std::size_t bytes = 0);

/// Returns the creation properties of a class of objects. Without time stamps, equal content gives equal bytes.
/// Tracking the order of attributes selects version 2 object headers, which hold attributes above 64 KiB.
Handle creation_list(hid_t kind);

/// Used by datasets and attributes.
Layout layout_of(const Handle& type, const Handle& space);
Handle make_space(const Shape& shape);

} // namespace keeler::io::hdf5
