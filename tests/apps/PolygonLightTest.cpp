// PolygonLightTest.cpp - the report's formula for irradiance compared with values found otherwise.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "apps/osgraytracebench/report/PolygonLight.h"

#include <cmath>

using namespace osgRayTrace::bench;
using osg::Vec3d;

namespace
{

const Vec3d kUp(0, 0, 1);

Polygon square(double x, double y, double z)
{
    return {Vec3d(x - 0.5, y - 0.5, z), Vec3d(x + 0.5, y - 0.5, z), Vec3d(x + 0.5, y + 0.5, z),
            Vec3d(x - 0.5, y + 0.5, z)};
}

/// Computes the irradiance by adding up small pieces of a unit square light at height 1 that the
/// function lets through.
template <typename Visible> double summed(const Vec3d& point, const Visible& visible)
{
    constexpr int kPieces = 1500;
    double sum = 0.0;
    for (int i = 0; i < kPieces; ++i)
    {
        for (int j = 0; j < kPieces; ++j)
        {
            const Vec3d q((i + 0.5) / kPieces - 0.5, (j + 0.5) / kPieces - 0.5, 1.0);
            const double d2 = (q - point).length2();
            if (visible(q)) sum += 1.0 / (d2 * d2); // both cosines are 1/d
        }
    }
    return sum / (double(kPieces) * kPieces);
}

} // namespace

TEST_CASE("polygon light: unit squares in closed form", "[report]")
{
    CHECK(irradiance(square(0, 0, 1), Vec3d(), kUp) == Approx(0.75227469).epsilon(1e-8));
    CHECK(irradiance(square(1, 0, 1), Vec3d(), kUp) == Approx(0.26500485).epsilon(1e-7));
    const Polygon standing{Vec3d(1, -0.5, 0), Vec3d(1, 0.5, 0), Vec3d(1, 0.5, 1),
                           Vec3d(1, -0.5, 1)};
    CHECK(irradiance(standing, Vec3d(), kUp) == Approx(0.22334663).epsilon(1e-7));
}

TEST_CASE("polygon light: what is below the horizon does not count", "[report]")
{
    const Polygon upper{Vec3d(1, -0.5, 0), Vec3d(1, 0.5, 0), Vec3d(1, 0.5, 1), Vec3d(1, -0.5, 1)};
    const Polygon whole{Vec3d(1, -0.5, -3), Vec3d(1, 0.5, -3), Vec3d(1, 0.5, 1), Vec3d(1, -0.5, 1)};
    CHECK(irradiance(whole, Vec3d(), kUp) ==
          Approx(irradiance(upper, Vec3d(), kUp)).epsilon(1e-12));
    CHECK(irradiance(square(0, 0, -1), Vec3d(), kUp) == 0.0);
}

TEST_CASE("polygon light: occluders against sums of pieces", "[report]")
{
    // The 1500^2 pieces miss an edge by half a piece at most: 1e-3 of the light.
    const Vec3d point(0.1, -0.05, 0.0);
    const double turn = 17.0 * M_PI / 180.0;
    const Vec3d across(std::cos(turn), std::sin(turn), 0.0), along(-across.y(), across.x(), 0.0);
    const Vec3d start(0.13, 0.0, 0.5);
    const Polygon edge{start - along * 9.0, start + across * 9.0 - along * 9.0,
                       start + across * 9.0 + along * 9.0, start + along * 9.0};
    const auto before = [&](const Vec3d& q) { return across * ((point + q) * 0.5 - start) < 0.0; };
    CHECK(irradiance(square(0, 0, 1), edge, point, kUp) ==
          Approx(summed(point, before)).margin(1e-3));

    const Polygon small{Vec3d(0.0, -0.1, 0.5), Vec3d(0.2, -0.1, 0.5), Vec3d(0.1, 0.1, 0.5)};
    const auto around = [&](const Vec3d& q)
    {
        const Vec3d m = (point + q) * 0.5;
        for (std::size_t i = 0; i < 3; ++i)
            if (((small[(i + 1) % 3] - small[i]) ^ (m - small[i])).z() < 0.0) return true;
        return false;
    };
    CHECK(irradiance(square(0, 0, 1), small, point, kUp) ==
          Approx(summed(point, around)).margin(1e-3));
    CHECK(irradiance(square(0, 0, 1), small, point, kUp) <
          irradiance(square(0, 0, 1), point, kUp) - 0.01);
}

TEST_CASE("polygon light: the way round an occluder's corners does not matter", "[report]")
{
    const Polygon one{Vec3d(0.0, -0.1, 0.5), Vec3d(0.2, -0.1, 0.5), Vec3d(0.1, 0.1, 0.5)};
    const Polygon other{one[2], one[1], one[0]};
    const Vec3d point(0.1, 0.2, 0.0);
    CHECK(irradiance(square(0, 0, 1), one, point, kUp) ==
          Approx(irradiance(square(0, 0, 1), other, point, kUp)).epsilon(1e-12));
}
