// Nephroid.cpp - the caustic of a concave mirror wall: the scene and its closed form.
// SPDX-License-Identifier: MIT
#include "tests/photons/Nephroid.h"

#include <cmath>

namespace osgRayTrace::engine::test
{

namespace
{

constexpr double kHalfArc = glm::pi<double>() / 3.0;
constexpr int kFacets = 4096;

/// Returns the wall from the floor to z = height, with the normals of the cylinder and its front
/// towards the axis. A facet is 5e-4 wide: positions are 3e-8 off the cylinder, and directions are
/// exact.
std::shared_ptr<Mesh> arc(float height)
{
    std::vector<Vec3> positions, normals;
    std::vector<UVec3> triangles;
    for (int k = 0; k <= kFacets; ++k)
    {
        const double phi = kHalfArc * (2.0 * k / kFacets - 1.0);
        for (const float z : {0.0f, height})
        {
            positions.emplace_back(std::cos(phi), std::sin(phi), z);
            normals.emplace_back(-std::cos(phi), -std::sin(phi), 0.0f);
        }
        if (k == kFacets) break;
        const auto a = static_cast<uint32_t>(2 * k);
        triangles.push_back({a, a + 1, a + 3});
        triangles.push_back({a, a + 3, a + 2});
    }
    auto mesh = newMesh(std::move(positions), std::move(triangles));
    mesh->normals = std::move(normals);
    return mesh;
}

} // namespace

/// The sun reaches the wall over the whole arc, and the floor before the wall.
SceneBuilder nephroid()
{
    SceneBuilder builder;
    builder.add(quadMesh({-0.5f, -1, 0}, {1.6f, 0, 0}, {0, 2, 0}), lambert(Vec3(1.0f)));
    builder.add(arc(1.0f), mirror(Vec3(1.0f)));
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(Vec3(1, 0, -1));
    sun.diffuse = Vec3(std::sqrt(2.0f)); // gives the floor a direct radiance of 1
    builder.addLight(sun);
    return builder;
}

double gainOnAxis(double x)
{
    const bool three = x > 0.5 && 1.0 / (2.0 * x) > std::cos(kHalfArc);
    return 1.0 / std::abs(1.0 - 2.0 * x) + (three ? 2.0 / (4.0 * x * x - 1.0) : 0.0);
}

/// Returns the mean of G over the disc: the share of light that lands there, ray by ray. Light that
/// meets the wall at azimuth phi and height z runs s = z; its flux is cos(phi) dphi dz, and G = 1
/// is a flux of 1 per unit area.
double meanGain(double x, double y, double radius, int steps)
{
    double sum = 0.0;
    for (int k = 0; k < steps; ++k)
    {
        const double phi = kHalfArc * (2.0 * (k + 0.5) / steps - 1.0);
        // The ray from (cos phi, sin phi) along (-cos 2 phi, -sin 2 phi) has a chord in the disc.
        const double dx = std::cos(phi) - x, dy = std::sin(phi) - y;
        const double along = dx * std::cos(2.0 * phi) + dy * std::sin(2.0 * phi);
        const double half2 = radius * radius - (dx * dx + dy * dy - along * along);
        if (half2 <= 0.0) continue;
        const double half = std::sqrt(half2);
        const double length = std::min(along + half, 1.0) - std::max(along - half, 0.0);
        if (length > 0.0) sum += std::cos(phi) * length * 2.0 * kHalfArc / steps;
    }
    return sum / (glm::pi<double>() * radius * radius);
}

} // namespace osgRayTrace::engine::test
