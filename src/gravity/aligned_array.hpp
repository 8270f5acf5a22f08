// Memory for FFTW and for wide registers: on whole cache lines, which is more than fftw_malloc aligns to and the same
// for each array, so plans made for one array serve all.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace keeler {

/// Plain numbers, not initialised. Growing forgets them.
template<class T> class AlignedArray {
public:
  AlignedArray() = default;
  AlignedArray(AlignedArray&& other) noexcept
      : size_(std::exchange(other.size_, 0)), numbers_(std::move(other.numbers_)) {}
  AlignedArray& operator=(AlignedArray&& other) noexcept {
    size_ = std::exchange(other.size_, 0);
    numbers_ = std::move(other.numbers_);
    return *this;
  }
  /// The memory of numbers of another kind, which are forgotten.
  template<class Other>
  explicit AlignedArray(AlignedArray<Other>&& other)
      : size_(std::exchange(other.size_, 0) * sizeof(Other) / sizeof(T)),
        numbers_(reinterpret_cast<T*>(other.numbers_.release())) {}

  void resize_at_least(std::size_t size) {
    if (size <= size_)
      return;
    numbers_.reset();
    size_ = 0;
    numbers_.reset(static_cast<T*>(::operator new(size * sizeof(T), line)));
    size_ = size;
  }
  T* data() { return numbers_.get(); }
  const T* data() const { return numbers_.get(); }

private:
  struct Free {
    void operator()(T* numbers) const { ::operator delete(numbers, line); }
  };
  static constexpr std::align_val_t line{64};
  template<class Other> friend class AlignedArray;

  std::size_t size_ = 0;
  std::unique_ptr<T, Free> numbers_;
};

} // namespace keeler
