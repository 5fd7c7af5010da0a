// MediumStack.h - the bodies that a point of a path is in. Layer: media.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace osgRayTrace::engine
{

/// Numbers a medium of a MediumTable. 0 is what is around all bodies.
using MediumId = uint16_t;
constexpr MediumId kOutside = 0;

/// A MediumStack holds up to four numbers of media, in the order in which the path has entered
/// them. A number may be in the stack more than once, if bodies of one material overlap. Entering a
/// fifth body is forgotten.
class MediumStack
{
public:
    MediumStack() = default;
    explicit MediumStack(uint64_t word) : _word(word) {}

    static constexpr int kSize = 4;

    uint64_t word() const { return _word; }
    bool isEmpty() const { return _word == 0; }
    bool isFull() const { return (_word >> 48) != 0; }

    /// Returns a number by its place from the one entered first; kOutside behind the last one.
    MediumId operator[](int place) const { return static_cast<MediumId>(_word >> (16 * place)); }

    bool has(MediumId medium) const
    {
        for (int k = 0; k < kSize; ++k)
            if ((*this)[k] == medium) return true;
        return false;
    }

    /// Returns the stack after the path has entered a body.
    MediumStack entered(MediumId medium) const
    {
        int count = 0;
        while (count < kSize && (*this)[count] != kOutside)
            ++count;
        return count == kSize ? *this : MediumStack(_word | uint64_t(medium) << (16 * count));
    }

    /// Returns the stack of a path that has been in the body before it entered any other.
    MediumStack begunIn(MediumId medium) const
    {
        return isFull() ? *this : MediumStack(_word << 16 | medium);
    }

    /// Returns the stack after the path has left a body, the last one of this number.
    MediumStack left(MediumId medium) const
    {
        for (int k = kSize - 1; k >= 0; --k)
        {
            if ((*this)[k] != medium) continue;
            const uint64_t below = _word & ((uint64_t(1) << (16 * k)) - 1u);
            const uint64_t above = k == kSize - 1 ? 0u : _word >> (16 * (k + 1)) << (16 * k);
            return MediumStack(below | above);
        }
        return *this;
    }

private:
    uint64_t _word = 0;
};

} // namespace osgRayTrace::engine
