// Math.h - the vector types of the engine and its small constants. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>

namespace osgRayTrace::engine
{

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Vec3d = glm::dvec3;
using Vec4d = glm::dvec4;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;
using Mat4d = glm::dmat4;
using UVec3 = glm::uvec3;

constexpr float kPi = 3.14159265358979323846f;
constexpr float kInvPi = 0.31830988618379067154f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kOneMinusEpsilon = 0x1.fffffep-1f; ///< the largest float below 1
constexpr uint32_t kInvalid = 0xffffffffu;         ///< the index that means "none"

/// An affine map of points: columns x, y, z and a translation. It has half the memory traffic of a
/// Mat4.
struct Affine
{
    Mat3 linear{1.0f};
    Vec3 translation{0.0f};
};

inline Vec3 transformPoint(const Affine& m, Vec3 p)
{
    return m.linear * p + m.translation;
}

/// Returns the matrix that takes normals to the space to which linear takes points: the inverse
/// transpose of linear, not normalised. It is computed in double, since shears and uneven scales
/// cancel.
inline Mat3 normalMatrix(const Mat3& linear)
{
    return Mat3(glm::transpose(glm::inverse(glm::dmat3(linear))));
}

/// Returns the Rec. 709 luminance of a linear RGB radiance.
inline float luminance(Vec3 c)
{
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

inline bool isFinite(Vec3 v)
{
    return v.x - v.x == 0.0f && v.y - v.y == 0.0f && v.z - v.z == 0.0f;
}

} // namespace osgRayTrace::engine
