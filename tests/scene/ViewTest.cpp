// ViewTest.cpp - camera rays of any projection compared with a reference in double.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/scene/View.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <optional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 1920, kHeight = 1080;

struct Ray
{
    Vec3d origin, direction;
};

/// Returns the ray through a pixel position, in engine space, from the linear form in float.
Ray rayAt(const CameraRays& c, float x, float y)
{
    return {Vec3d(c.origin + x * c.originDx + y * c.originDy),
            Vec3d(c.direction + x * c.directionDx + y * c.directionDy)};
}

/// Returns the distance in pixels between (x, y) and the projection of points of the ray through
/// (x, y), in double.
double pixelError(const View& view, const Vec3d& origin, const CameraRays& rays, double x, double y)
{
    const Ray ray = rayAt(rays, static_cast<float>(x), static_cast<float>(y));
    const double length = glm::length(ray.direction);
    double worst = 0.0;
    for (const double s : {double(rays.nearS), 1.5 + rays.nearS, 100.0 / length + rays.nearS})
    {
        const Vec3d p = ray.origin + s * ray.direction;
        // The view and the translation are multiplied first, because large numbers cancel there.
        Mat4d viewFromEngine = view.viewFromWorld;
        viewFromEngine[3] = view.viewFromWorld * Vec4d(origin, 1.0);
        const Vec4d clip = view.clipFromView * (viewFromEngine * Vec4d(p, 1.0));
        const double px = (clip.x / clip.w + 1.0) * 0.5 * view.width;
        const double py = (clip.y / clip.w + 1.0) * 0.5 * view.height;
        worst = std::max(worst, std::hypot(px - x, py - y));
    }
    return worst;
}

double worstPixelError(const View& view, const Vec3d& origin)
{
    const std::optional<CameraRays> rays = cameraRays(view, origin);
    REQUIRE(rays);
    double worst = 0.0;
    for (const double x : {0.5, 13.25, 960.0, 1919.5})
    {
        for (const double y : {0.5, 540.0, 1079.5})
            worst = std::max(worst, pixelError(view, origin, *rays, x, y));
    }
    return worst;
}

View viewOf(const Mat4d& clipFromView, const Mat4d& viewFromWorld)
{
    View view;
    view.width = kWidth;
    view.height = kHeight;
    view.clipFromView = clipFromView;
    view.viewFromWorld = viewFromWorld;
    return view;
}

const Mat4d kLookAt = glm::lookAt(Vec3d(3, -5, 2), Vec3d(0.5, 0.25, 0.125), Vec3d(0, 0, 1));

/// Returns glm::frustum with the far plane at infinity.
Mat4d infiniteFrustum(double left, double right, double bottom, double top, double zNear)
{
    Mat4d m = glm::frustum(left, right, bottom, top, zNear, 2.0 * zNear);
    m[2][2] = -1.0;
    m[3][2] = -2.0 * zNear;
    return m;
}

/// Returns a projection whose depth goes from 1 at the near plane to -1 at the far plane.
Mat4d reversed(Mat4d m)
{
    for (int column = 0; column < 4; ++column)
        m[column][2] = -m[column][2];
    return m;
}

struct PixelErrors
{
    double ours = 0.0, best = 0.0; ///< largest [pixels]
};

/// Returns the errors all over a perspective picture: those of our rays, and those of the best rays
/// in float, which are exact directions of length 1, rounded.
PixelErrors errorsEverywhere(const View& view)
{
    const std::optional<CameraRays> rays = cameraRays(view, Vec3d(0.0));
    REQUIRE(rays);
    const Mat4d viewFromClip = glm::inverse(view.clipFromView);
    const glm::dmat3 viewFromEngine(view.viewFromWorld);
    PixelErrors errors;
    for (double x = 0.5; x < view.width; x += 31.0)
    {
        for (double y = 0.5; y < view.height; y += 31.0)
        {
            errors.ours = std::max(errors.ours, pixelError(view, Vec3d(0.0), *rays, x, y));
            const Vec4d near = viewFromClip * Vec4d(2.0 * x / view.width - 1.0,
                                                    2.0 * y / view.height - 1.0, -1.0, 1.0);
            const Vec3d exact = glm::inverse(viewFromEngine) * (Vec3d(near) / near.w);
            const Vec3d rounded = viewFromEngine * Vec3d(Vec3(glm::normalize(exact)));
            const Vec4d clip = view.clipFromView * Vec4d(rounded, 1.0);
            const double px = (clip.x / clip.w + 1.0) * 0.5 * view.width;
            const double py = (clip.y / clip.w + 1.0) * 0.5 * view.height;
            errors.best = std::max(errors.best, std::hypot(px - x, py - y));
        }
    }
    return errors;
}

} // namespace

TEST_CASE("camera rays: within a thousandth of a pixel for every kind of projection",
          "[scene][stability 18][stability 19]")
{
    const double aspect = double(kWidth) / kHeight;
    const Mat4d perspective = glm::perspective(0.8, aspect, 0.1, 100.0);
    struct Case
    {
        const char* name;
        Mat4d projection;
        double tolerance = 1e-3; // [pixels]
    };
    // Rays are float: if a pixel subtends a small part of the direction, the direction's 2^-24
    // become visible.
    const Case projections[] = {
        {"perspective", perspective},
        {"narrow", glm::perspective(0.02, aspect, 1.0, 1e4), 4e-3},
        {"wide", glm::perspective(2.8, aspect, 0.1, 100.0), 2e-3},
        {"off-axis wall", glm::frustum(-0.1, 0.35, -0.02, 0.3, 0.1, 100.0)},
        {"wall beside the eye", glm::frustum(0.5, 0.9, 0.2, 0.6, 0.1, 100.0), 2e-3},
        {"left eye", glm::frustum(-0.085, 0.105, -0.05, 0.055, 0.1, 100.0)},
        {"right eye", glm::frustum(-0.105, 0.085, -0.05, 0.055, 0.1, 100.0)},
        {"infinite far plane", infiniteFrustum(-0.1, 0.35, -0.02, 0.3, 0.1)},
        {"reversed depth", reversed(perspective)},
        {"reversed depth, infinite far plane",
         reversed(infiniteFrustum(-0.1, 0.1, -0.06, 0.06, 0.1))},
        {"near .01, far 1e8", glm::perspective(0.8, aspect, 0.01, 1e8)},
        {"near .01, far 1e8, off-axis", glm::frustum(-0.01, 0.035, -0.002, 0.03, 0.01, 1e8)},
        {"orthographic", glm::ortho(-2.0, 3.0, -1.0, 2.0, 0.1, 50.0)},
        {"orthographic, near plane behind", glm::ortho(-2.0, 3.0, -1.0, 2.0, -20.0, 50.0)},
        {"scaled clip space", perspective * 7.5},
    };
    for (const Case& c : projections)
    {
        CAPTURE(c.name);
        CHECK(worstPixelError(viewOf(c.projection, kLookAt), Vec3d(0.0)) < c.tolerance);
    }
}

TEST_CASE("camera rays: what floats cannot hold, and no more than that", "[scene][stability 18]")
{
    // A component of a direction of length 1 is rounded by up to 2^-25. In h pixels of a view of
    // angle a this is an error of 2^-25 h / a, which is 1.6e-3 at 0.02 radians; for a wall beside
    // the eye, seen at 6 degrees, the error is larger. An origin makes up for an angle at one
    // distance only. Our linear form rounds its terms as well.
    const double aspect = double(kWidth) / kHeight;
    const Mat4d narrow = glm::perspective(0.02, aspect, 1.0, 1e4);
    const Mat4d beside = glm::frustum(0.5, 0.9, 0.2, 0.6, 0.1, 100.0);
    for (const Mat4d& projection : {narrow, beside})
    {
        const PixelErrors errors = errorsEverywhere(viewOf(projection, kLookAt));
        CAPTURE(errors.ours, errors.best);
        CHECK(errors.best > 1e-3);
        CHECK(errors.ours < 2.0 * errors.best);
    }
    // Very wide views allow for more: their terms are the larger ones.
    const PixelErrors wide =
        errorsEverywhere(viewOf(glm::perspective(2.8, aspect, 0.1, 100.0), kLookAt));
    CAPTURE(wide.ours, wide.best);
    CHECK(wide.best < 5e-4);
    CHECK(wide.ours < 1e-3);
}

TEST_CASE("camera rays: the same at the radius of the earth, with the origin there", "[scene]")
{
    for (const Vec3d& far : {Vec3d(6.378137e6, 0, 0), Vec3d(4.51e6, 4.51e6, 0)})
    {
        const Mat4d viewFromWorld =
            glm::lookAt(far + Vec3d(3, -5, 2), far + Vec3d(0.5, 0.25, 0.125), Vec3d(0, 0, 1));
        for (const Mat4d& projection : {glm::perspective(0.8, 16.0 / 9.0, 0.1, 100.0),
                                        glm::perspective(0.8, 16.0 / 9.0, 0.01, 1e8),
                                        glm::frustum(-0.1, 0.35, -0.02, 0.3, 0.1, 100.0),
                                        glm::ortho(-2.0, 3.0, -1.0, 2.0, 0.1, 50.0)})
        {
            const View view = viewOf(projection, viewFromWorld);
            CHECK(worstPixelError(view, far) < 1e-3);
            const std::optional<CameraRays> displaced = cameraRays(view, far);
            const std::optional<CameraRays> atOrigin =
                cameraRays(viewOf(projection, kLookAt), Vec3d(0.0));
            REQUIRE((displaced && atOrigin));
            // The eye is known to the double precision of the matrix: 6e6 * 2^-53 * a few.
            CHECK(glm::length(displaced->origin - atOrigin->origin) < 1e-6f);
        }
    }
}

TEST_CASE("camera rays: perspective rays start at the near plane, s = 1", "[scene]")
{
    for (const bool isReversed : {false, true})
    {
        Mat4d projection = glm::perspective(0.8, 1.0, 0.25, 100.0);
        if (isReversed) projection = reversed(projection);
        View view = viewOf(projection, kLookAt);
        const std::optional<CameraRays> rays = cameraRays(view, Vec3d(0.0));
        REQUIRE(rays);
        CHECK_FALSE(rays->orthographic);
        CHECK(rays->nearS == 1.0f);
        const Ray ray = rayAt(*rays, 400.0f, 300.0f);
        const Vec3d near = Vec3d(view.viewFromWorld * Vec4d(ray.origin + ray.direction, 1.0));
        CHECK(near.z == Approx(-0.25).epsilon(1e-6));
        CHECK(glm::length(ray.origin - Vec3d(3, -5, 2)) < 1e-6);
    }
}

TEST_CASE("camera rays: orthographic rays start on the near plane and are parallel", "[scene]")
{
    const View view = viewOf(glm::ortho(-2.0, 3.0, -1.0, 2.0, 0.5, 50.0), kLookAt);
    const std::optional<CameraRays> rays = cameraRays(view, Vec3d(0.0));
    REQUIRE(rays);
    CHECK(rays->orthographic);
    CHECK(rays->nearS == 0.0f);
    CHECK(rays->directionDx == Vec3(0.0f));
    CHECK(rays->directionDy == Vec3(0.0f));
    const Vec3d start = Vec3d(view.viewFromWorld * Vec4d(rayAt(*rays, 700.0f, 20.0f).origin, 1.0));
    CHECK(start.z == Approx(-0.5).margin(1e-5));
    const Vec3d forward =
        glm::dmat3(view.viewFromWorld) * glm::normalize(rayAt(*rays, 0.0f, 0.0f).direction);
    CHECK(forward.z == Approx(-1.0));
}

TEST_CASE("camera rays: window depths along rays are those of the matrix, whichever way depth runs",
          "[scene]")
{
    const Mat4d perspective = glm::perspective(0.8, 1.5, 0.25, 40.0);
    const Mat4d parallel = glm::ortho(-2.0, 3.0, -1.0, 2.0, 0.25, 40.0);
    Mat4d oblique = perspective;
    oblique[0][2] += 0.03; // the near plane is not at right angles to the view
    const struct
    {
        const char* name;
        Mat4d matrix;
        double nearDepth;
    } cases[] = {{"perspective", perspective, 0.0},
                 {"off-axis", glm::frustum(0.5, 0.9, 0.2, 0.6, 0.25, 40.0), 0.0},
                 {"reversed", reversed(perspective), 1.0},
                 {"infinite", infiniteFrustum(-0.1, 0.3, -0.1, 0.1, 0.25), 0.0},
                 {"reversed infinite", reversed(infiniteFrustum(-0.1, 0.3, -0.1, 0.1, 0.25)), 1.0},
                 {"oblique", oblique, 0.0},
                 {"scaled", perspective * 7.5, 0.0},
                 {"orthographic", parallel, 0.0},
                 {"orthographic, reversed", reversed(parallel), 1.0}};
    for (const auto& c : cases)
    {
        CAPTURE(c.name);
        const View view = viewOf(c.matrix, kLookAt);
        const std::optional<CameraRays> rays = cameraRays(view, Vec3d(0.0));
        REQUIRE(rays);
        CHECK(rays->nearDepth == c.nearDepth);
        for (const float x : {10.5f, 900.5f, 1900.5f})
        {
            const float y = 700.5f;
            const Ray ray = rayAt(*rays, x, y);
            for (const double distance : {0.5, 3.0, 30.0})
            {
                const double s = rays->nearS + distance / glm::length(ray.direction);
                const Vec4d p = view.viewFromWorld * Vec4d(ray.origin + s * ray.direction, 1.0);
                CHECK(p.z < 0.0); // in front of the eye
                const Vec4d clip = view.clipFromView * p;
                const double change =
                    rays->orthographic ? s : 1.0 / s - 1.0 - x * rays->depthDx - y * rays->depthDy;
                CHECK(rays->nearDepth + rays->depthSlope * change ==
                      Approx(0.5 + 0.5 * clip.z / clip.w).margin(1e-6));
            }
        }
    }
}

TEST_CASE("camera rays: depth rows give the clip coordinates of engine points", "[scene]")
{
    const Vec3d origin(100.0, -50.0, 25.0);
    const View view = viewOf(glm::perspective(0.8, 1.5, 0.1, 100.0), kLookAt);
    const std::optional<CameraRays> rays = cameraRays(view, origin);
    REQUIRE(rays);
    const Vec3d world(0.5, 0.25, 0.125);
    const Vec4d clip = view.clipFromView * view.viewFromWorld * Vec4d(world, 1.0);
    const Vec4 p(Vec3(world - origin), 1.0f);
    CHECK(glm::dot(rays->depthRow, p) == Approx(clip.z).epsilon(1e-4));
    CHECK(glm::dot(rays->wRow, p) == Approx(clip.w).epsilon(1e-4));
}

TEST_CASE("camera rays: no size or no inverse gives none", "[scene][stability 20]")
{
    const Mat4d projection = glm::perspective(0.8, 1.0, 0.1, 100.0);
    View view = viewOf(projection, kLookAt);
    for (const auto& [width, height] :
         {std::pair(0, 10), std::pair(10, 0), std::pair(0, 0), std::pair(-4, 10)})
    {
        view.width = width;
        view.height = height;
        CHECK_FALSE(cameraRays(view, Vec3d(0.0)));
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Mat4d flat(1.0);
    flat[2][2] = 0.0;
    for (const Mat4d& bad : {Mat4d(0.0), flat, Mat4d(nan), Mat4d(HUGE_VAL)})
    {
        CHECK_FALSE(cameraRays(viewOf(bad, kLookAt), Vec3d(0.0)));
        CHECK_FALSE(cameraRays(viewOf(projection, bad), Vec3d(0.0)));
    }
    CHECK_FALSE(cameraRays(viewOf(projection, kLookAt), Vec3d(nan)));
}

TEST_CASE("stability 3: camera rays of a scaled world in a scaled unit are the same", "[scene]")
{
    const Vec3d origin(0.5, -0.25, 2.0);
    const auto scaled = [](double s)
    {
        return std::vector<Mat4d>{
            glm::perspective(0.8, 16.0 / 9.0, 0.125 * s, 64.0 * s),
            glm::frustum(-0.1 * s, 0.35 * s, -0.02 * s, 0.3 * s, 0.1 * s, 100.0 * s),
            glm::ortho(-2.0 * s, 3.0 * s, -1.0 * s, 2.0 * s, 0.125 * s, 50.0 * s),
            // The eye is beside the view's origin, as in stereo: the pole has a length of its own.
            glm::translate(glm::perspective(0.8, 1.0, 0.125 * s, 64.0 * s), Vec3d(0.03 * s, 0, 0))};
    };
    const std::vector<Mat4d> ordinary = scaled(1.0);
    for (const double unit : {0x1p-100, 0x1p-40, 0x1p40, 0x1p100})
    {
        Mat4d viewFromWorld = kLookAt;
        for (int row = 0; row < 3; ++row)
            viewFromWorld[3][row] *= unit;
        const std::vector<Mat4d> projections = scaled(unit);
        for (std::size_t i = 0; i < projections.size(); ++i)
        {
            CAPTURE(unit, i);
            const auto rays =
                cameraRays(viewOf(projections[i], viewFromWorld), origin * unit, unit);
            const auto expected = cameraRays(viewOf(ordinary[i], kLookAt), origin);
            REQUIRE((rays && expected));
            CHECK(rays->orthographic == expected->orthographic);
            CHECK(rays->origin == expected->origin);
            CHECK(rays->originDx == expected->originDx);
            CHECK(rays->direction == expected->direction);
            CHECK(rays->directionDx == expected->directionDx);
            CHECK(rays->directionDy == expected->directionDy);
            CHECK(rays->nearDepth == expected->nearDepth);
            CHECK(rays->depthSlope == expected->depthSlope);
            // Clip coordinates may have a common factor.
            const float factor =
                rays->wRow == Vec4(0, 0, 0, rays->wRow.w) ? rays->wRow.w / expected->wRow.w : 1.0f;
            CHECK(rays->wRow == expected->wRow * factor);
            CHECK(rays->depthRow == expected->depthRow * factor);
        }
    }
}
