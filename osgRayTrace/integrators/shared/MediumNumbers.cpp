// MediumNumbers.cpp - the random numbers of sixteen stretches at once. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/MediumNumbers.h"

namespace osgRayTrace::engine
{

OSGRAYTRACE_KERNEL
void setNumbers(const MediumNumbers* numbers, uint32_t dimension, FloatLanes& x, FloatLanes& y)
{
    const uint32_t own = dimension;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        numbers[i].set(own, x[i], y[i]);
}

} // namespace osgRayTrace::engine
