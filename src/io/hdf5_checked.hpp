// For hdf5*.cpp. One door to HDF5: its own printing is off during a call, and a failure becomes an IoError with
// its reason in our words.
#pragma once

#include "hdf5.hpp"

#include <string>

namespace keeler::hdf5 {

/// Switches HDF5's error printing off while it lives.
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

/// Throws IoError "cannot WHAT: reason of the last failure".
[[noreturn]] void fail(const std::string& what);

/// Calls and returns the result; a negative one is a failure. `what` completes "cannot ...".
template<class Call> auto checked(const std::string& what, const Call& call) {
  const Quiet quiet;
  const auto result = call();
  if (result < 0)
    fail(what);
  return result;
}

/// HDF5 takes two files of one name for the same file: a name that no other file has.
std::string fresh_name();

/// HDF5 crashes in places where an allocation fails. So what it is about to take, and some for itself, is tried before:
/// throws std::bad_alloc.
void require_memory(std::size_t bytes = 0);

/// What objects of a kind are made with. No time stamps: equal content gives equal bytes. Attributes keep their order,
/// which makes HDF5 take object headers of version 2 with room for attributes beyond 64 KiB.
Handle creation_list(hid_t kind);

/// Shared by datasets and attributes.
Layout layout_of(const Handle& type, const Handle& space);
Handle make_space(const Shape& shape);

} // namespace keeler::hdf5
