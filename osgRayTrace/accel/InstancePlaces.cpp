// InstancePlaces.cpp - checks and hashes of instances' transforms. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/InstancePlaces.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

double reachOf(const Affine& m)
{
    double largest = 0.0, columnProduct = 1.0;
    for (int column = 0; column < 3; ++column)
    {
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::fabs(double(m.linear[column][row])));
        columnProduct *= glm::length(glm::dvec3(m.linear[column]));
    }
    // The determinant of a flatter parallelepiped of columns consists of rounding errors. NaN
    // fails, too.
    const double determinant = glm::determinant(glm::dmat3(m.linear));
    if (!(largest < 1e12) || !(std::fabs(determinant) > 1e-6 * columnProduct)) return 0.0;

    const glm::dmat3 localFromEngine = glm::inverse(glm::dmat3(m.linear));
    double enlargement = 1.0; // the largest sum of a row
    for (int row = 0; row < 3; ++row)
        enlargement = std::max(enlargement, std::fabs(localFromEngine[0][row]) +
                                                std::fabs(localFromEngine[1][row]) +
                                                std::fabs(localFromEngine[2][row]));
    const double reach = kLargestCoordinate / enlargement;
    const double distance =
        std::max({std::fabs(double(m.translation.x)), std::fabs(double(m.translation.y)),
                  std::fabs(double(m.translation.z))});
    if (!(enlargement < 2e9) || !isFinite(m.translation) || distance > 0.5 * reach) return 0.0;
    return reach - distance;
}

uint64_t hashOf(uint64_t serial, uint32_t instance, const Affine& m)
{
    float values[12];
    std::memcpy(values, &m.linear, 9 * sizeof(float));
    std::memcpy(values + 9, &m.translation, 3 * sizeof(float));
    uint64_t hash = (serial ^ (uint64_t(instance) << 32)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
    for (int i = 0; i < 12; i += 2)
    {
        uint64_t bits;
        std::memcpy(&bits, values + i, sizeof bits);
        hash = (hash ^ bits) * 0xbf58476d1ce4e5b9u;
        hash ^= hash >> 29;
    }
    return hash;
}

bool samePlace(const Instance& a, const Instance& b)
{
    return a.placed == b.placed &&
           (!a.placed || (a.engineFromLocal.linear == b.engineFromLocal.linear &&
                          a.engineFromLocal.translation == b.engineFromLocal.translation));
}

} // namespace osgRayTrace::engine
