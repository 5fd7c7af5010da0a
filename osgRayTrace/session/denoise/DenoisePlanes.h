// DenoisePlanes.h - the denoiser's arrays of pixels and of cells of two by two pixels. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/LargeArray.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds rows of cells with a margin that holds one value, so that whoever reads neighbours need
/// not ask whether they exist.
class CellPlane
{
public:
    static constexpr int kMargin = 16;

    /// Sets the size, and all cells to outside. Throws std::bad_alloc.
    void allocate(int width, int height, float outside)
    {
        _stride = static_cast<std::size_t>((width + kLanes - 1) / kLanes * kLanes + 2 * kMargin);
        allocateLarge(_values, _stride * static_cast<std::size_t>(height + 2 * kMargin));
        for (float& value : _values)
            value = outside;
    }

    /// Returns row y in [-kMargin, height + kMargin), whose cells are [-kMargin, width + kMargin).
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

/// Holds rows of pixels.
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

/// Marks cells in which no light is known. The value is so far from all light that nothing is mixed
/// with it, and small enough to be calculated with.
constexpr float kNoLight = 1e30f;

/// Returns about exp(-x), and 0 from 8 on: (1 - x/8)^8.
OSGRAYTRACE_INLINE float fallOff(float x)
{
    const float base = 1.0f - 0.125f * x;
    const float a = base > 0.0f ? base : 0.0f;
    const float b = a * a, c = b * b;
    return c * c;
}

} // namespace osgRayTrace::engine
