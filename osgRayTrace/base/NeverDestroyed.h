// NeverDestroyed.h - static objects that threads may use to the process's very end. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <new>
#include <utility>

namespace osgRayTrace::engine
{

/// A T that is constructed where it stands and never destroyed: what every static object must be
/// that has a destructor. exit() destroys static objects while other threads go on: a viewer's main
/// thread may draw while another one ends the process. Takes no memory of its own, and what the T
/// owns stays reachable for leak checkers.
///
///     static const NeverDestroyed<std::vector<Row>> rows(std::vector<Row>{...});
template <typename T> class NeverDestroyed
{
public:
    template <typename... Arguments> explicit NeverDestroyed(Arguments&&... arguments)
    {
        new (_place) T(std::forward<Arguments>(arguments)...);
    }
    NeverDestroyed(const NeverDestroyed&) = delete;
    NeverDestroyed& operator=(const NeverDestroyed&) = delete;

    T& operator*() { return *std::launder(reinterpret_cast<T*>(_place)); }
    const T& operator*() const { return *std::launder(reinterpret_cast<const T*>(_place)); }
    T* operator->() { return &**this; }
    const T* operator->() const { return &**this; }

private:
    alignas(T) unsigned char _place[sizeof(T)];
};

} // namespace osgRayTrace::engine
