// NeverDestroyed.h - static objects that threads may use to the end of the process. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <new>
#include <utility>

namespace osgRayTrace::engine
{

/// A T that is constructed in place and never destroyed. Every static object that has a destructor
/// must be a NeverDestroyed: exit() destroys static objects while other threads go on, and a
/// viewer's main thread may draw while another thread ends the process. A NeverDestroyed takes no
/// memory beside the T, and leak checkers can still reach what the T owns.
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
