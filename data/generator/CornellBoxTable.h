// CornellBoxTable.h - the measurements of the Cornell box, for whoever builds it. Part of the scene
// generator.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace::data::cornell
{

/// Any vector of three components, made from plain numbers: this table knows no library.
struct Triple
{
    float x, y, z;

    template <class Vector> constexpr Vector as() const { return Vector(x, y, z); }
};

using Corners = Triple[4];

// Positions as measured [CornellBox]: x to the left in the picture, y up, z away from the camera
// [mm].
constexpr Corners kFloor{{552.8f, 0, 0}, {0, 0, 0}, {0, 0, 559.2f}, {549.6f, 0, 559.2f}};
constexpr Corners kCeiling{
    {556, 548.8f, 0}, {556, 548.8f, 559.2f}, {0, 548.8f, 559.2f}, {0, 548.8f, 0}};
constexpr Corners kLight{
    {343, 548.8f, 227}, {343, 548.8f, 332}, {213, 548.8f, 332}, {213, 548.8f, 227}};
constexpr Corners kBackWall{
    {549.6f, 0, 559.2f}, {0, 0, 559.2f}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}};
constexpr Corners kRightWall{{0, 0, 559.2f}, {0, 0, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}};
constexpr Corners kLeftWall{
    {552.8f, 0, 0}, {549.6f, 0, 559.2f}, {556, 548.8f, 559.2f}, {556, 548.8f, 0}};

/// The bases of the blocks; their tops lie right above.
constexpr Corners kShortBase{{130, 0, 65}, {82, 0, 225}, {240, 0, 272}, {290, 0, 114}};
constexpr Corners kTallBase{{423, 0, 247}, {265, 0, 296}, {314, 0, 456}, {472, 0, 406}};
constexpr float kShortHeight = 165.0f, kTallHeight = 330.0f;

/// A scene without a hole in the ceiling has its light this high, just below it.
constexpr float kLoweredLight = 548.7f;

// Linear RGB stand-ins for the measured spectra, as other renderers use them.
constexpr Triple kWhite{0.73f, 0.73f, 0.73f};
constexpr Triple kRed{0.65f, 0.05f, 0.05f};
constexpr Triple kGreen{0.12f, 0.45f, 0.15f};
constexpr Triple kRadiance{17.0f, 12.0f, 4.0f};

/// Builds the box without holes: quad(a, b, c, d, albedo) for each wall,
/// block(base corners, height, albedo) and light(corner, edgeU, edgeV, radiance), which looks down.
template <class Vector, class Quad, class Block, class Light>
void build(const Quad& quad, const Block& block, const Light& light)
{
    const auto of = [](const Triple& t) { return t.as<Vector>(); };
    const auto wall = [&](const Corners& c, const Triple& albedo)
    { quad(of(c[0]), of(c[1]), of(c[2]), of(c[3]), of(albedo)); };
    wall(kFloor, kWhite);
    wall(kCeiling, kWhite);
    wall(kBackWall, kWhite);
    wall(kRightWall, kGreen);
    wall(kLeftWall, kRed);
    const auto base = [&](const Corners& c, float height)
    {
        const Vector corners[] = {of(c[0]), of(c[1]), of(c[2]), of(c[3])};
        block(corners, height, of(kWhite));
    };
    base(kShortBase, kShortHeight);
    base(kTallBase, kTallHeight);
    const auto edge = [&](const Triple& end)
    { return Vector(end.x - kLight[0].x, 0.0f, end.z - kLight[0].z); };
    light(Vector(kLight[0].x, kLoweredLight, kLight[0].z), edge(kLight[1]), edge(kLight[3]),
          of(kRadiance));
}

} // namespace osgRayTrace::data::cornell
