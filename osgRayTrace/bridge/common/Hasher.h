// Hasher.h - combines many values into one number, to tell whether one has changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ObjectIdentity.h"

#include <osg/Matrixd>

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace osgRayTrace::engine
{

/// Mixes values one after the other into 64 bits.
class Hasher
{
public:
    /// kept: gets references to the objects that are added. whoever compares the value with a later
    /// one holds them until then. Null: the value is compared with an earlier one, whose objects
    /// are held.
    explicit Hasher(KeptObjects* kept = nullptr) : _kept(kept) {}

    uint64_t value() const { return _value; }

    template <class T> void add(const T& item)
    {
        static_assert(!std::is_pointer_v<T>, "see addObject and addData");
        if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
        {
            uint64_t bits = 0;
            static_assert(sizeof(item) <= sizeof(bits));
            std::memcpy(&bits, &item, sizeof(item));
            addBits(bits);
        }
        else
        {
            for (unsigned int i = 0; i < T::num_components; ++i)
                add(item[i]);
        }
    }

    template <class First, class... Rest> void add(const First& first, const Rest&... rest)
    {
        add(first);
        (add(rest), ...);
    }

    /// Adds the identity of an object, which may be null, but not its values.
    void addObject(const osg::Referenced* object)
    {
        addData(object);
        if (_kept && object) _kept->push_back(keep(object));
    }

    /// Adds the address of an object's data, which is one sign of a change among others.
    void addData(const void* data) { add(reinterpret_cast<uintptr_t>(data)); }

    void addMatrix(const osg::Matrixd& matrix)
    {
        for (int i = 0; i < 16; ++i)
            add(matrix.ptr()[i]);
    }

private:
    void addBits(uint64_t bits) // mix64 of SplitMix [Steele14], chained
    {
        uint64_t z = (_value ^ bits) + 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        _value = z ^ (z >> 31);
    }

    uint64_t _value = 0;
    KeptObjects* _kept;
};

} // namespace osgRayTrace::engine
