// LazyArray.h - big arrays of values that begin one by one. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/LargeArray.h"

#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

namespace osgRayTrace::engine
{

/// A big array whose values are constructed when they are first needed, each by the thread that
/// needs it. The array is on huge pages if the system has some to spare.
template <class T> class LazyArray
{
    static_assert(std::is_trivially_destructible_v<T>, "nothing is destroyed");

public:
    /// Drops all values, and makes room for size others. Throws std::bad_alloc.
    void reset(std::size_t size)
    {
        std::vector<T*>(size).swap(_values);
        _memory = UnclearedArray<Room>(size);
    }

    std::size_t size() const { return _values.size(); }
    bool empty() const { return _values.empty(); }
    std::size_t bytes() const { return size() * (sizeof(Room) + sizeof(T*)); }

    /// Returns a value; null: it has not begun.
    T* operator[](std::size_t i) const { return _values[i]; }

    /// Begins a value. Different threads may begin different ones.
    template <class... Arguments> T* begin(std::size_t i, const Arguments&... arguments)
    {
        return _values[i] = new (&_memory[i]) T(arguments...);
    }

private:
    struct alignas(T) Room
    {
        std::byte bytes[sizeof(T)];
    };

    UnclearedArray<Room> _memory;
    std::vector<T*> _values;
};

} // namespace osgRayTrace::engine
