// Memory for FFTW and for wide registers, aligned to cache lines: stricter than fftw_malloc, and equal for all arrays,
// so a plan made for one array can be executed on any other.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace keeler::gravity {

/// An array of trivial values, not initialised. Growing loses them.
template<class T> class AlignedArray {
  static_assert(std::is_trivially_destructible_v<T>);

public:
  AlignedArray() = default;
  AlignedArray(AlignedArray&& other) noexcept
      : size_(std::exchange(other.size_, 0)), values_(std::move(other.values_)) {}
  AlignedArray& operator=(AlignedArray&& other) noexcept {
    size_ = std::exchange(other.size_, 0);
    values_ = std::move(other.values_);
    return *this;
  }

  /// Makes room for `size` values at least.
  void resize_at_least(std::size_t size) {
    if (size <= size_)
      return;
    values_.reset();
    size_ = 0;
    values_.reset(static_cast<T*>(::operator new(size * sizeof(T), line)));
    size_ = size;
  }
  T* data() { return values_.get(); }
  const T* data() const { return values_.get(); }

private:
  struct Free {
    void operator()(T* values) const { ::operator delete(values, line); }
  };
  static constexpr std::align_val_t line{64};

  std::size_t size_ = 0;
  std::unique_ptr<T, Free> values_;
};

} // namespace keeler::gravity
