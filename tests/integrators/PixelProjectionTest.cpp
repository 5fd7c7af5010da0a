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

TEST_CASE("pixel projection: a pixel's area on a plane is that of its corners", "[integrators]")
{
    Uniform random(2);
    for (const View& view : views())
    {
        const std::optional<CameraRays> camera = cameraRays(view, Vec3d(0.0));
        REQUIRE(camera);
        const PixelProjection projection(*camera);
        const Plane plane{glm::normalize(Vec3(0.2f, -0.3f, 1.0f)), 0.1f};
        for (int k = 0; k < 200; ++k)
        {
            const float x = std::floor(kWidth * random()), y = std::floor(kHeight * random());
            const std::optional<Vec3> a = projection.onPlane(x, y, plane),
                                      b = projection.onPlane(x + 1, y, plane),
                                      c = projection.onPlane(x + 1, y + 1, plane),
                                      d = projection.onPlane(x, y + 1, plane),
                                      middle = projection.onPlane(x + 0.5f, y + 0.5f, plane);
            if (!a || !b || !c || !d || !middle) continue;
            const double expected = 0.5 * double(glm::length(glm::cross(*c - *a, *d - *b)));
            const PixelProjection::Place place = projection.place(*middle);
            CAPTURE(camera->orthographic, x, y);
            CHECK(double(glm::dot(*middle, plane.normal)) == Approx(0.1).margin(1e-4));
            CHECK(double(projection.pixelArea(*middle, place.s, plane.normal)) ==
                  Approx(expected).epsilon(5e-3));
        }
    }
}

TEST_CASE("pixel projection: a plane behind the view is not seen", "[integrators]")
{
    for (const View& view : views())
    {
        const std::optional<CameraRays> camera = cameraRays(view, Vec3d(0.0));
        REQUIRE(camera);
        const PixelProjection projection(*camera);
        const Vec3 ahead = glm::normalize(projection.direction(kWidth / 2.0f, kHeight / 2.0f));
        const Vec3 behind = projection.origin(kWidth / 2.0f, kHeight / 2.0f) - ahead;
        CHECK_FALSE(
            projection.onPlane(kWidth / 2.0f, kHeight / 2.0f, {ahead, glm::dot(ahead, behind)}));
    }
}
