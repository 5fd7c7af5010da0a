// ChannelTest.cpp - depth, normals, positions, ids, errors and debug pictures of a rendered view.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/film/ToneMap.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 37, kHeight = 21;

/// A tilted plane that fills the view but for the left part, which is empty.
struct TiltedPlane
{
    Vec3d origin{1000.0, -2000.0, 500.0}; ///< of the scene
    Vec3d corner = origin + Vec3d(-1.0, -4.0, -1.0), u{8.0, 0.0, 2.0}, v{0.0, 8.0, 1.0};
    Vec3d normal = glm::normalize(glm::cross(u, v));

    SceneBuilder build() const
    {
        SceneBuilder builder;
        builder.scene->origin = origin;
        builder.add(quadMesh(Vec3(500.0f), {1, 0, 0}, {0, 1, 0}),
                    lambert(Vec3(0.1f))); // out of sight
        builder.add(quadMesh(Vec3(corner - origin), Vec3(u), Vec3(v)),
                    lambert(Vec3(0.2f, 0.4f, 0.6f)));
        return builder;
    }
};

std::vector<View> views(const TiltedPlane& plane)
{
    View perspective =
        perspectiveView(plane.origin + Vec3d(0.5, 0.5, 6), plane.origin + Vec3d(0.2, 0, 0),
                        {0, 1, 0}, 50.0, kWidth, kHeight);
    perspective.clipFromView = glm::perspective(0.9, double(kWidth) / kHeight, 0.5, 40.0);
    View orthographic = perspective;
    orthographic.clipFromView = glm::ortho(-4.0, 3.0, -2.0, 2.0, 0.5, 40.0);
    View offAxis = perspective;
    offAxis.clipFromView = glm::frustum(-0.4, 0.1, -0.1, 0.3, 0.5, 40.0);
    return {perspective, orthographic, offAxis};
}

struct Truth
{
    bool hit = false;
    Vec3d position{0.0};
    double depth = 1.0, distance = 0.0;
};

/// Returns the point in which the line through a pixel's centre meets the plane, by the matrices in
/// double.
Truth truthAt(const View& view, const TiltedPlane& plane, int x, int y)
{
    const Mat4d worldFromClip = glm::inverse(view.clipFromView * view.viewFromWorld);
    const auto point = [&](double z)
    {
        const Vec4d p = worldFromClip * Vec4d(2.0 * (x + 0.5) / kWidth - 1.0,
                                              2.0 * (y + 0.5) / kHeight - 1.0, z, 1.0);
        return Vec3d(p) / p.w;
    };
    const Vec3d near = point(-1.0), far = point(1.0);
    const double t =
        glm::dot(plane.corner - near, plane.normal) / glm::dot(far - near, plane.normal);
    Truth truth;
    truth.position = near + t * (far - near);
    const Vec3d local = truth.position - plane.corner;
    const Vec4d clip = view.clipFromView * view.viewFromWorld * Vec4d(truth.position, 1.0);
    // These are the parallelogram's coordinates of the point.
    const double uu = glm::dot(plane.u, plane.u), vv = glm::dot(plane.v, plane.v),
                 uv = glm::dot(plane.u, plane.v);
    const double lu = glm::dot(local, plane.u), lv = glm::dot(local, plane.v),
                 det = uu * vv - uv * uv;
    const double a = (lu * vv - lv * uv) / det, b = (lv * uu - lu * uv) / det;
    truth.hit = a > 0.0 && a < 1.0 && b > 0.0 && b < 1.0 && t > 0.0;
    if (truth.hit) truth.depth = 0.5 * clip.z / clip.w + 0.5;
    return truth;
}

} // namespace

TEST_CASE("channels: depth, normal, position and id agree with the matrices", "[session]")
{
    const TiltedPlane plane;
    const auto traced = plane.build().build();
    for (const View& view : views(plane))
    {
        RenderSession session(std::make_shared<Workers>(2));
        session.setScene(traced);
        session.setView(view);
        session.setOptions(optionsOf(IntegratorKind::Whitted));
        StopRule rule;
        rule.passes = 3;
        REQUIRE(session.render(rule).status.ok());
        const std::vector<float> depth = session.resolveChannel(Channel::Depth);
        const std::vector<float> distance = session.resolveChannel(Channel::Distance);
        const std::vector<float> normal = session.resolveChannel(Channel::Normal);
        const std::vector<float> albedo = session.resolveChannel(Channel::Albedo);
        const std::vector<float> position = session.resolveChannel(Channel::Position);
        const std::vector<float> id = session.resolveChannel(Channel::Id);
        REQUIRE(depth.size() == kWidth * kHeight);
        REQUIRE(normal.size() == 3 * kWidth * kHeight);
        int hits = 0, misses = 0, depthErrors = 0;
        for (int y = 0; y < kHeight; ++y)
        {
            for (int x = 0; x < kWidth; ++x)
            {
                const Truth truth = truthAt(view, plane, x, y);
                const auto at = static_cast<std::size_t>(y * kWidth + x);
                CAPTURE(x, y);
                // The first pass takes the depth of a random point of the pixel: at the plane's
                // edge this point may miss the plane.
                depthErrors += std::abs(depth[at] - truth.depth) > 2e-6;
                if (!truth.hit)
                {
                    ++misses;
                    REQUIRE(id[at] == 0.0f);
                    REQUIRE(distance[at] == kInfinity);
                    REQUIRE(normal[3 * at] == 0.0f);
                    continue;
                }
                ++hits;
                REQUIRE(id[at] == 2.0f);
                const Vec3d seen(position[3 * at], position[3 * at + 1], position[3 * at + 2]);
                REQUIRE(glm::length(seen - truth.position) < 5e-4); // float at 2000
                const Vec3d n(normal[3 * at], normal[3 * at + 1], normal[3 * at + 2]);
                REQUIRE(glm::length(n - plane.normal) < 1e-6);
                REQUIRE(albedo[3 * at + 2] == Approx(0.6f));
            }
        }
        CHECK(hits > 100);
        CHECK(misses > 100);
        CHECK(depthErrors < 2 * kHeight);

        // The display's depth is the depth channel.
        std::vector<uint8_t> bytes(4 * kWidth * kHeight);
        std::vector<float> displayDepth(kWidth * kHeight);
        session.resolveDisplay(ToneMap(), bytes.data(), displayDepth.data());
        CHECK(displayDepth == depth);
    }
}

TEST_CASE("channels: normals face the viewer on back sides", "[session]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-5, -5, 0}, {0, 10, 0}, {10, 0, 0}),
                lambert(Vec3(0.5f))); // its front faces downwards
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(builder.build());
    session.setView(patchView({0, 0, 0}, {0, 0, 1}, 1.0, 4));
    StopRule rule;
    rule.passes = 1;
    session.render(rule);
    const std::vector<float> normal = session.resolveChannel(Channel::Normal);
    CHECK(normal[2] == 1.0f);
}

TEST_CASE("channels: the error channel holds the halves' difference", "[session]")
{
    RenderSession session(std::make_shared<Workers>(2));
    session.setScene(cornellBox().build());
    session.setView(cornellView(32, 32));
    session.setOptions(optionsOf(IntegratorKind::Path, 3));
    StopRule rule;
    rule.passes = 8;
    session.render(rule);
    const std::vector<float> error = session.resolveChannel(Channel::Error),
                             image = session.resolveRadiance();
    // The expected value is the square root of the channel's mean square, relative to the mean of
    // 16 x 16 pixels, as in the session's estimate.
    double sum = 0.0;
    for (std::size_t tile = 0; tile < 4; ++tile)
    {
        for (std::size_t c = 0; c < 3; ++c)
        {
            double squares = 0.0, mean = 0.0;
            for (std::size_t i = 0; i < 256; ++i)
            {
                const std::size_t pixel = (tile / 2 * 16 + i / 16) * 32 + tile % 2 * 16 + i % 16;
                squares += double(error[3 * pixel + c]) * error[3 * pixel + c];
                mean += image[4 * pixel + c] / 256.0;
            }
            sum += squares / (mean * mean + 0.01);
        }
    }
    CHECK(std::sqrt(sum / (3.0 * 32 * 32)) ==
          Approx(session.estimateError().relative).epsilon(1e-4));
}

TEST_CASE("channels: their sizes", "[session]")
{
    CHECK(channelSize(Channel::Depth) == 1);
    CHECK(channelSize(Channel::Distance) == 1);
    CHECK(channelSize(Channel::Id) == 1);
    CHECK(channelSize(Channel::Normal) == 3);
    CHECK(channelSize(Channel::Albedo) == 3);
    CHECK(channelSize(Channel::Position) == 3);
    CHECK(channelSize(Channel::Error) == 3);
}

TEST_CASE("debug integrator: each channel shows what it says", "[session]")
{
    auto mesh = quadMesh({-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
    mesh->uvs = std::vector<Vec2>{{0, 0}, {4, 0}, {4, 2}, {0, 2}};
    SceneBuilder builder;
    builder.add(mesh, lambert(Vec3(0.2f, 0.4f, 0.6f)));
    const auto traced = builder.build();
    const View view = patchView({2.0, 1.0, 0}, {0, 0, 1}, 0.01, 4);
    const auto shown = [&](DebugChannel channel)
    {
        RenderOptions options = optionsOf(IntegratorKind::Debug);
        options.debugChannel = channel;
        const Picture picture = render(traced, view, options, 1);
        CHECK(picture.progress.droppedSamples == 0);
        CHECK(picture.rgba[3] == 1.0f);
        return picture.mean();
    };
    CHECK(glm::length(shown(DebugChannel::Normal) - Vec3(0.5f, 0.5f, 1.0f)) < 1e-6f);
    CHECK(glm::length(shown(DebugChannel::Uv) - Vec3(0.8f, 0.2f, 0.0f)) <
          5e-3f); // (2.8, 1.2) modulo 1
    CHECK(glm::length(shown(DebugChannel::Albedo) - Vec3(0.2f, 0.4f, 0.6f)) < 1e-6f);
    CHECK(shown(DebugChannel::Dropped) == Vec3(0.0f));
    CHECK(shown(DebugChannel::Id) == shown(DebugChannel::Id));
    CHECK(shown(DebugChannel::Id) != Vec3(0.0f));
    CHECK(shown(DebugChannel::Cost).x >= 1.0f / 64.0f);
    // The plane is halfway between the near and the far plane of an orthographic view: these are
    // 0.5 and 2 sides away, and the plane is 1 side away.
    CHECK(shown(DebugChannel::Depth).x == Approx(1.0 / 3.0).epsilon(1e-3));
}
