// DepthSlicesTest.cpp - one picture for slices of depth: planes and depths compared with matrices.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/DepthSlices.h"

#include "tests/Catch.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace osgRayTrace::engine;

namespace
{

View viewOf(const Mat4d& clipFromView)
{
    View view;
    view.clipFromView = clipFromView;
    view.width = view.height = 64;
    return view;
}

Mat4d reversed(Mat4d m)
{
    for (int column = 0; column < 4; ++column)
        m[column][2] = -m[column][2];
    return m;
}

/// Returns the window depth at a distance along -z.
double windowDepth(const View& view, double distance)
{
    const Vec4d clip = view.clipFromView * Vec4d(0.0, 0.0, -distance, 1.0);
    return 0.5 + 0.5 * clip.z / clip.w;
}

constexpr double kNear = 0.01, kFar = 10000.0;

/// These are the planes of three slices that follow each other.
constexpr double kPlanes[] = {kNear, 1.0, 100.0, kFar};

} // namespace

TEST_CASE("depth slices: planes of a view from its matrix", "[session]")
{
    struct Case
    {
        const char* name;
        Mat4d matrix;
        double far = 20.0;
    };
    Mat4d infinite = glm::frustum(-1.0, 2.0, -1.0, 1.0, 0.5, 1.0);
    infinite[2][2] = -1.0;
    infinite[3][2] = -1.0;
    const Mat4d perspective = glm::frustum(-1.0, 2.0, -1.0, 1.0, 0.5, 20.0);
    const Mat4d parallel = glm::ortho(-1.0, 2.0, -1.0, 1.0, 0.5, 20.0);
    const double unbounded = std::numeric_limits<double>::infinity();
    for (const Case& c :
         {Case{"perspective", perspective}, Case{"scaled", 3.0 * perspective},
          Case{"reversed", reversed(perspective)}, Case{"infinite", infinite, unbounded},
          Case{"reversed infinite", reversed(infinite), unbounded}, Case{"orthographic", parallel},
          Case{"reversed orthographic", reversed(parallel)}})
    {
        CAPTURE(c.name);
        const std::optional<DepthPlanes> planes = depthPlanes(viewOf(c.matrix));
        REQUIRE(planes);
        CHECK(planes->near == Approx(0.5));
        if (std::isfinite(c.far))
            CHECK(planes->far == Approx(c.far));
        else
            CHECK(planes->far > 1e12);
        CHECK(planes->reversed() == (c.name[0] == 'r'));
    }
    Mat4d oblique = perspective;
    oblique[0][2] = 0.1; // the depth changes with x
    CHECK_FALSE(depthPlanes(viewOf(oblique)));
}

TEST_CASE("depth slices: depths of the traced view become those of each slice", "[session]")
{
    const bool orthographic = GENERATE(false, true);
    const bool isReversed = GENERATE(false, true);
    CAPTURE(orthographic, isReversed);
    std::vector<View> slices;
    for (int i = 2; i >= 0; --i)
    {
        const double n = kPlanes[i], f = kPlanes[i + 1];
        const Mat4d matrix = orthographic ? glm::ortho(-1.0, 2.0, -1.0, 1.0, n, f)
                                          : glm::frustum(-1.0 * n, 2.0 * n, -n, n, n, f);
        slices.push_back(viewOf(isReversed ? reversed(matrix) : matrix));
    }
    const View traced = viewOfSlices(slices);
    for (std::size_t i = 0; i < slices.size(); ++i)
    {
        CAPTURE(i);
        const DepthMap map = depthMap(slices[i], slices);
        CHECK((map.background < 0.0f) == (i != 0));
        if (i == 0) CHECK(map.background == Approx(isReversed ? 0.0 : 1.0).margin(1e-6));
        for (double distance = kNear; distance < kFar; distance *= 1.25)
        {
            const double expected = windowDepth(slices[i], distance);
            const double depth = windowDepth(traced, distance);
            // A film keeps float depths, and a shader computes in float.
            const float stored = static_cast<float>(depth);
            const float shown = map.scale * stored + map.offset;
            if (!orthographic) CHECK((depth > 0.0 && depth <= 1.0 + 1e-12));
            const bool inside =
                distance > kPlanes[2 - i] * 1.001 && distance < kPlanes[3 - i] * 0.999;
            const bool outside =
                distance < kPlanes[2 - i] * 0.999 || distance > kPlanes[3 - i] * 1.001;
            // The tolerance is three units of a buffer of 24 bits; all slices of a parallel view
            // share the floats of one depth range.
            const double tolerance =
                orthographic ? 6e-8 * kFar / (kPlanes[3 - i] - kPlanes[2 - i]) : 1.8e-7;
            if (inside) CHECK(std::fabs(shown - expected) < tolerance);
            if (outside) CHECK((shown < 0.0f || shown > 1.0f));
        }
    }
}

TEST_CASE("depth slices: rays and depths of views are compared apart", "[session]")
{
    const View a = viewOf(glm::perspective(0.8, 1.0, 1.0, 10.0));
    const View b = viewOf(glm::perspective(0.8, 1.0, 10.0, 100.0));
    View turned = a;
    turned.viewFromWorld[3][0] = 1e-9;
    CHECK(sameRays(a, b));
    CHECK_FALSE(sameDepth(a, b));
    CHECK_FALSE(sameRays(a, turned));
    CHECK(sameDepth(a, turned));
    CHECK(withDepthOf(a, b) == b);
    CHECK_FALSE(depthMap(a).background < 0.0f);
}
