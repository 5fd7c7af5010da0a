// DenoisePlanes.h - the arrays that the denoiser works on: pixels, and cells of two by two of them.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/LargeArray.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Rows of cells with a margin that holds one value, so that who looks at neighbours need not ask
/// whether there are any.
class CellPlane
{
public:
    static constexpr int kMargin = 16;

    /// All of outside. Throws std::bad_alloc.
    void allocate(int width, int height, float outside)
    {
        _stride = static_cast<std::size_t>((width + kLanes - 1) / kLanes * kLanes + 2 * kMargin);
        allocateLarge(_values, _stride * static_cast<std::size_t>(height + 2 * kMargin));
        for (float& value : _values)
            value = outside;
    }

    /// y in [-kMargin, height + kMargin); its cells [-kMargin, width + kMargin).
    float* row(int y) { return _values.data() + offset(y); }
    const float* row(int y) const { return _values.data() + offset(y); }

private:
    std::size_t offset(int y) const
    {
        return static_cast<std::size_t>(y + kMargin) * _stride + kMargin;
    }

    std::size_t _stride = 0;
    std::vector<float> _values;
};

/// Rows of pixels.
template <class T> class PixelPlane
{
public:
    void allocate(int width, int height)
    {
        _width = static_cast<std::size_t>(width);
        allocateLarge(_values, _width * static_cast<std::size_t>(height));
    }
    T* row(int y) { return _values.data() + static_cast<std::size_t>(y) * _width; }
    const T* row(int y) const { return _values.data() + static_cast<std::size_t>(y) * _width; }

private:
    std::size_t _width = 0;
    std::vector<T> _values;
};

/// Where no light is known: so far from all that is that nothing is mixed with it, and small enough
/// to be calculated with.
constexpr float kNoLight = 1e30f;

/// About exp(-x), and 0 from 8 on: (1 - x/8)^8.
OSGRAYTRACE_INLINE float fallOff(float x)
{
    const float base = 1.0f - 0.125f * x;
    const float a = base > 0.0f ? base : 0.0f;
    const float b = a * a, c = b * b;
    return c * c;
}

} // namespace osgRayTrace::engine
