// LargeArray.h - big arrays that are written once a frame. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Platform.h"

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Sets values to size zeros, on huge pages if the system has some to spare. A frame writes a part
/// of each tile at once, and with small pages each part would miss the translation buffer. Throws
/// std::bad_alloc.
template <class T> void allocateLarge(std::vector<T>& values, std::size_t size)
{
    std::vector<T>().swap(values);
    values.reserve(size);
    preferHugePages(values.data(), size * sizeof(T));
    values.resize(size);
}

/// A big array of plain values that begins uninitialised. Threads that write all of the array
/// would have to wait for one that clears it, and the first touch of the pages is work that the
/// threads share. The array is on huge pages if the system has some to spare. Throws
/// std::bad_alloc.
template <class T> class UnclearedArray
{
    static_assert(std::is_trivial_v<T>, "nothing is constructed");

public:
    UnclearedArray() = default;
    explicit UnclearedArray(std::size_t size) : _size(size), _capacity(size)
    {
        if (size == 0) return;
        const std::size_t page = size * sizeof(T) >= kHugePage ? kHugePage : 64;
        const std::size_t bytes = (size * sizeof(T) + page - 1) / page * page;
        _values = static_cast<T*>(allocateAligned(page, bytes));
        if (!_values) throw std::bad_alloc();
        if (page == kHugePage) preferHugePages(_values, bytes);
    }
    ~UnclearedArray() { freeAligned(_values); }
    UnclearedArray(UnclearedArray&& other) noexcept { swap(other); }
    UnclearedArray& operator=(UnclearedArray&& other) noexcept
    {
        swap(other);
        return *this;
    }
    /// Exchanges the values of the two arrays; none is copied.
    void swap(UnclearedArray& other) noexcept
    {
        std::swap(_values, other._values);
        std::swap(_size, other._size);
        std::swap(_capacity, other._capacity);
    }

    /// Sets the size, and leaves all values undefined. Keeps the memory unless it is too small or
    /// more than twice what is needed. Memory in place of other memory has room for a sixteenth
    /// more, as the size may vary a little from time to time. Throws std::bad_alloc, and the array
    /// is then empty.
    void reuse(std::size_t size)
    {
        if (size > _capacity || _capacity / 2 > size)
        {
            const std::size_t room = _capacity > 0 ? size / 16 : 0;
            UnclearedArray().swap(*this); // frees first: both need not stand beside each other
            UnclearedArray(size + room).swap(*this);
        }
        _size = size;
    }

    std::size_t size() const { return _size; }
    std::size_t capacity() const { return _capacity; } ///< values that the memory has room for
    T* data() { return _values; }
    const T* data() const { return _values; }
    T& operator[](std::size_t i) { return _values[i]; }
    const T& operator[](std::size_t i) const { return _values[i]; }

private:
    static constexpr std::size_t kHugePage = std::size_t(1) << 21;

    T* _values = nullptr;
    std::size_t _size = 0;
    std::size_t _capacity = 0;
};

} // namespace osgRayTrace::engine
