// PixelProjectionTest.cpp - points of any view's rays project back to their pixels.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/integrators/shared/PixelProjection.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 640, kHeight = 360;

View withProjection(const Mat4d& clipFromView)
{
    View view = perspectiveView({3, -4, 5}, {0.5, 0.2, 0}, {0, 0, 1}, 50.0, kWidth, kHeight);
    view.clipFromView = clipFromView;
    return view;
}

/// Returns a perspective, an off-axis, a parallel, an off-axis parallel and a sheared view.
std::vector<View> views()
{
    Mat4d sheared(1.0);
    sheared[2][0] = 0.3;
    sheared[2][1] = -0.2;
    const Mat4d perspective = glm::perspective(glm::radians(50.0), 16.0 / 9.0, 0.1, 100.0);
    return {withProjection(perspective),
            withProjection(glm::frustum(-0.02, 0.11, 0.01, 0.07, 0.1, 100.0)),
            withProjection(glm::ortho(-3.0, 3.0, -1.7, 1.7, 0.1, 100.0)),
            withProjection(glm::ortho(-1.0, 5.0, 0.3, 3.7, 0.1, 100.0) * sheared),
            withProjection(perspective * sheared)};
}

} // namespace

TEST_CASE("pixel projection: points of rays are where their rays are", "[integrators]")
{
    Uniform random(1);
    for (const View& view : views())
    {
        const std::optional<CameraRays> camera = cameraRays(view, Vec3d(0.0));
        REQUIRE(camera);
        const PixelProjection projection(*camera);
        for (int k = 0; k < 1000; ++k)
        {
            const float x = kWidth * random(), y = kHeight * random();
            const float s = camera->nearS + (camera->orthographic ? 0.5f : 500.0f) * random();
            const Vec3 point = projection.origin(x, y) + s * projection.direction(x, y);
            const PixelProjection::Place place = projection.place(point);
            CAPTURE(camera->orthographic, x, y, s);
            CHECK(double(place.x) == Approx(x).margin(5e-3));
            CHECK(double(place.y) == Approx(y).margin(5e-3));
            CHECK(double(place.s) == Approx(s).epsilon(1e-4).margin(1e-4));
        }
    }
}

namespace
{

/// Returns the point of a plane that the ray at (x, y) meets before the camera, or nothing.
std::optional<Vec3d> seenAt(const PixelProjection& projection, double x, double y,
                            const Plane& plane)
{
    const Vec3d normal(plane.normal), origin(projection.origin(float(x), float(y))),
        direction(projection.direction(float(x), float(y)));
    const double s =
        (double(plane.offset) - glm::dot(normal, origin)) / glm::dot(normal, direction);
    if (!(s > 0.0) || !std::isfinite(s)) return std::nullopt;
    return origin + s * direction;
}

/// Returns sixteen pixels by chance.
PixelLanes somePixels(Uniform& random)
{
    PixelLanes pixels;
    for (int i = 0; i < kLanes; ++i)
    {
        pixels.x[i] = std::floor(kWidth * random());
        pixels.y[i] = std::floor(kHeight * random());
    }
    return pixels;
}

/// Returns a plane in all lanes.
PlaneLanes allLanes(const Plane& plane)
{
    PlaneLanes planes;
    for (int i = 0; i < kLanes; ++i)
    {
        setLane(planes.normal, i, plane.normal);
        planes.offset[i] = plane.offset;
    }
    return planes;
}

} // namespace

TEST_CASE("pixel projection: footprints hold what pixels see of a plane", "[integrators]")
{
    Uniform random(2);
    int seen = 0, left = 0;
    for (const View& view : views())
    {
        const std::optional<CameraRays> camera = cameraRays(view, Vec3d(0.0));
        REQUIRE(camera);
        const PixelProjection projection(*camera);
        for (int k = 0; k < 30; ++k)
        {
            // The second plane is seen from its side.
            const Plane plane = k % 3 ? Plane{glm::normalize(Vec3(0.2f, -0.3f, 1.0f)), 0.1f}
                                      : Plane{glm::normalize(Vec3(0.9f, 0.5f, -0.05f)), 0.2f};
            const PixelLanes pixels = somePixels(random);
            FootprintLanes footprints;
            projection.footprints(pixels, allLanes(plane), footprints);
            for (int i = 0; i < kLanes; ++i)
            {
                const double x = double(pixels.x[i]), y = double(pixels.y[i]);
                const std::optional<Vec3d> a = seenAt(projection, x, y, plane),
                                           b = seenAt(projection, x + 1, y, plane),
                                           c = seenAt(projection, x + 1, y + 1, plane),
                                           d = seenAt(projection, x, y + 1, plane),
                                           middle = seenAt(projection, x + 0.5, y + 0.5, plane);
                CAPTURE(camera->orthographic, x, y, k);
                if (!a || !b || !c || !d || !middle)
                {
                    CHECK(footprints.radius[i] == 0.0f);
                    continue;
                }
                double radius = 0.0;
                for (const std::optional<Vec3d>& corner : {a, b, c, d})
                    radius = std::max(radius, glm::length(*corner - *middle));
                const Vec3 point(*middle);
                const float s = projection.place(point).s;
                const double area = double(projection.pixelArea(point, s, plane.normal));
                if (!(radius * radius < 15.5 * area)) // of 16
                {
                    left += footprints.radius[i] == 0.0f;
                    continue;
                }
                ++seen;
                // Both planes are within ten units of the camera, and pixels as small as 0.01.
                const double polygon = 0.5 * glm::length(glm::cross(*c - *a, *d - *b));
                CHECK(double(footprints.area[i]) == Approx(polygon).epsilon(0.01));
                CHECK(area == Approx(polygon).epsilon(0.01));
                CHECK(double(footprints.radius[i]) == Approx(radius).epsilon(2e-3).margin(1e-5));
                CHECK(glm::length(Vec3d(laneOf(footprints.centre, i)) - *middle) < 1e-4);
            }
        }
    }
    CHECK(seen > 1000);
    CHECK(left > 50);
}

TEST_CASE("pixel projection: a plane behind the view is not seen", "[integrators]")
{
    Uniform random(3);
    for (const View& view : views())
    {
        const std::optional<CameraRays> camera = cameraRays(view, Vec3d(0.0));
        REQUIRE(camera);
        const PixelProjection projection(*camera);
        const Vec3 ahead = glm::normalize(projection.direction(kWidth / 2.0f, kHeight / 2.0f));
        const Vec3 behind = projection.origin(kWidth / 2.0f, kHeight / 2.0f) - ahead;
        PixelLanes pixels = somePixels(random);
        pixels.x[0] = kWidth / 2;
        pixels.y[0] = kHeight / 2;
        FootprintLanes footprints;
        projection.footprints(pixels, allLanes({ahead, glm::dot(ahead, behind)}), footprints);
        CHECK(footprints.radius[0] == 0.0f);
    }
}
