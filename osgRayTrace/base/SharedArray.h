// SharedArray.h - an immutable array together with the owner of its storage. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// A view of contiguous elements that shares ownership of their storage: a vector of the engine, or
/// an array of the host's scene graph, which is then not copied. Copies of a SharedArray are cheap.
template <class T> class SharedArray
{
public:
    SharedArray() = default;

    /// Takes the vector over.
    SharedArray(std::vector<T>&& values)
    {
        auto owner = std::make_shared<std::vector<T>>(std::move(values));
        _data = owner->data();
        _size = owner->size();
        _owner = std::move(owner);
    }

    /// Borrows size elements at data for the lifetime of owner; nobody may write to the elements.
    SharedArray(const T* data, std::size_t size, std::shared_ptr<const void> owner)
        : _data(data), _size(size), _owner(std::move(owner))
    {
    }

    const T* data() const { return _data; }
    std::size_t size() const { return _size; }
    bool empty() const { return _size == 0; }
    const T& operator[](std::size_t i) const { return _data[i]; }
    const T* begin() const { return _data; }
    const T* end() const { return _data + _size; }

private:
    const T* _data = nullptr;
    std::size_t _size = 0;
    std::shared_ptr<const void> _owner;
};

} // namespace osgRayTrace::engine
