// UpsampleTest.cpp - upsampled images: edges, depths and colours are those of a full-size image.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/session/CentredPass.h"

#include <cmath>
#include <cstdlib>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Holds a reduced image of the full-size view, and the upsampled image.
struct Upsampled
{
    ResolvedImage small, image;
    std::vector<SurfaceSample> samples;
    UpsampleCounts counts;
    ResolvedImage reference; ///< of full size, through the middles of the pixels
};

/// Upsamples an image that has one pixel for divider x divider pixels, and one for the rest at the
/// sides.
Upsampled upsampled(const std::shared_ptr<const TracedScene>& scene, const View& view, int divider,
                    int threads = 2)
{
    Upsampled result;
    View smaller = view;
    smaller.width = (view.width + divider - 1) / divider;
    smaller.height = (view.height + divider - 1) / divider;
    RenderSession session(std::make_shared<Workers>(threads));
    result.reference = centredImage(session, scene, view);
    result.small = centredImage(session, scene, smaller);
    result.samples = session.surfaceSamples();
    result.counts =
        session.upsample(result.small, result.samples, view.width, view.height, result.image);
    REQUIRE(result.image.width == view.width);
    REQUIRE(result.image.height == view.height);
    REQUIRE(result.image.radiance.size() == result.reference.radiance.size());
    REQUIRE(result.image.depth.size() == result.reference.depth.size());
    return result;
}

Vec4 pixelOf(const ResolvedImage& image, int x, int y)
{
    const float* p = &image.radiance[4 * static_cast<std::size_t>(y * image.width + x)];
    return Vec4(p[0], p[1], p[2], p[3]);
}

/// Returns whether two pixels are alike but for traces of unlike samples, which have a small weight
/// if there are no others around the pixel.
bool isNear(Vec4 a, Vec4 b)
{
    return glm::length(a - b) < 1e-4f;
}

float largestDepthError(const Upsampled& u)
{
    float largest = 0.0f;
    for (std::size_t i = 0; i < u.image.depth.size(); ++i)
        largest = std::max(largest, std::abs(u.image.depth[i] - u.reference.depth[i]));
    return largest;
}

/// Returns an unlit material: its radiance is what it emits, wherever it is seen.
Material glowing(Vec3 radiance)
{
    return lamp(radiance);
}

View frontView(int width, int height)
{
    return perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50.0, width, height);
}

} // namespace

TEST_CASE("upsampling: an edge between two colours is where it is in a full-size image",
          "[session][upsample]")
{
    // The scene has two halves of different depth and colour; their edge is slanted, so that it
    // crosses the pixels in all ways.
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}), glowing({0.1f, 0.2f, 0.9f}));
    builder.add(quadMesh({-9, -9, 0}, {8, 0, 0}, {3, 18, 0}), glowing({0.9f, 0.4f, 0.1f}));
    const auto scene = builder.build();
    for (const int divider : {2, 3, 4, 8})
    {
        const Upsampled u = upsampled(scene, frontView(161, 97), divider);
        int different = 0, left = 0;
        for (int y = 0; y < u.image.height; ++y)
            for (int x = 0; x < u.image.width; ++x)
            {
                different += pixelOf(u.image, x, y) != pixelOf(u.reference, x, y);
                left += pixelOf(u.image, x, y).x > 0.5f;
            }
        CAPTURE(divider, u.counts.traced);
        CHECK(different == 0);
        CHECK(left > 161 * 97 / 4);
        CHECK(left < 161 * 97 * 3 / 4);
        CHECK(largestDepthError(u) <= 1e-6f);
        CHECK(u.counts.traced < 161 * 97 / (divider < 8 ? 2 : 1)); // the rest is interpolated
    }
}

TEST_CASE("upsampling: depths of planes are those of a full-size image, in any projection",
          "[session][upsample]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-40, -1, 4}, {80, 0, 0}, {0, 0, -80}),
                lambert(Vec3(0.5f))); // a floor to the horizon
    builder.add(quadMesh({-1, -1, -2}, {2, 0, 1}, {0, 2, 0}), lambert(Vec3(0.5f)));
    builder.scene->lights.push_back(pointLight({-1, 3, 3}));
    const auto scene = builder.build();
    const auto check = [&](const View& view, float tolerance)
    {
        for (const int divider : {2, 4, 5})
        {
            const Upsampled u = upsampled(scene, view, divider);
            CAPTURE(divider, u.counts.traced);
            CHECK(largestDepthError(u) <= tolerance);
            CHECK(u.counts.traced < static_cast<uint64_t>(view.width * view.height) * 3 / 5);
            CHECK(u.counts.traced > 0);
        }
    };
    const View perspective = frontView(203, 130);
    check(perspective, 2e-6f);
    View offAxis = perspective;
    offAxis.clipFromView = glm::frustum(-0.2, 0.9, -0.6, 0.3, 1.0, 100.0);
    check(offAxis, 2e-6f);
    View reversed = perspective;
    reversed.clipFromView =
        glm::scale(Mat4d(1.0), Vec3d(1.0, 1.0, -1.0)) * perspective.clipFromView;
    check(reversed, 2e-6f);
    View orthographic = perspective;
    orthographic.viewFromWorld = glm::lookAt(Vec3d(3, 4, 6), Vec3d(0, 0, 0), Vec3d(0, 1, 0));
    orthographic.clipFromView = glm::ortho(-3.0, 4.0, -2.0, 3.0, 0.1, 100.0);
    check(orthographic, 2e-6f);
}

TEST_CASE("upsampling: a step of one object that its normals and colours do not show",
          "[session][upsample]")
{
    // The mesh has two parallel faces, one as far behind the other as a few pixels are wide.
    SceneBuilder builder;
    builder.add(newMesh({{-9, -9, 0},
                         {-1, -9, 0},
                         {2, 9, 0},
                         {-9, 9, 0},
                         {-9, -9, -0.2f},
                         {9, -9, -0.2f},
                         {9, 9, -0.2f},
                         {-9, 9, -0.2f}},
                        {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}),
                lambert(Vec3(0.5f)));
    builder.scene->lights.push_back(pointLight({0, 0, 5}));
    const auto scene = builder.build();
    for (const int divider : {2, 4})
    {
        const Upsampled u = upsampled(scene, frontView(161, 97), divider);
        CAPTURE(divider, u.counts.traced);
        CHECK(largestDepthError(u) <= 1e-6f);
        CHECK(u.counts.traced < 161 * 97 / 2);
    }
}

TEST_CASE("upsampling: one colour stays exactly that, whatever has it", "[session][upsample]")
{
    SceneBuilder builder;
    const Material same = glowing({0.3f, 0.6f, 0.1f});
    builder.add(quadMesh({-20, -20, -5}, {40, 0, 0}, {0, 40, 0}), same);
    builder.add(sphereMesh({-1, 0, 0}, 1.0f, 8), same);
    builder.add(boxMesh({0.5f, -1, -1}, {1.5f, 1, 1}), same);
    for (int i = 0; i < 5; ++i)
        builder.add(quadMesh({-2.0f + i, -2, 1}, {0.01f, 0, 0}, {0.5f, 4, 0}), same);
    const auto scene = builder.build();
    for (const int divider : {1, 2, 3, 4, 7, 8})
    {
        const Upsampled u = upsampled(scene, frontView(131, 77), divider);
        int different = 0;
        for (int y = 0; y < u.image.height; ++y)
            for (int x = 0; x < u.image.width; ++x)
                different += pixelOf(u.image, x, y) != Vec4(0.3f, 0.6f, 0.1f, 1.0f);
        CAPTURE(divider);
        CHECK(different == 0);
        CHECK(u.counts.traced > 0);
    }
}

TEST_CASE("upsampling: where there is nothing, it stays transparent", "[session][upsample]")
{
    SceneBuilder builder;
    builder.add(sphereMesh({0, 0, 0}, 1.5f, 12), lambert(Vec3(0.8f)));
    builder.scene->lights.push_back(pointLight({3, 3, 6}));
    for (const int divider : {2, 4, 8})
    {
        const Upsampled u = upsampled(builder.build(), frontView(150, 101), divider);
        int wrong = 0, covered = 0, black = 0;
        for (int y = 0; y < u.image.height; ++y)
            for (int x = 0; x < u.image.width; ++x)
            {
                const Vec4 p = pixelOf(u.image, x, y), r = pixelOf(u.reference, x, y);
                wrong += p.w != r.w || (r.w == 0.0f && p != Vec4(0.0f));
                covered += p.w == 1.0f;
                black += r.x > 0.05f && p.x == 0.0f;
            }
        CAPTURE(divider);
        CHECK(wrong == 0);
        CHECK(black == 0);
        CHECK(covered > 2000);
    }
}

TEST_CASE("upsampling: a bar of one pixel survives where it is found, and has its own colour",
          "[session][upsample]")
{
    // The bar is one pixel of the full size wide. It is slanted, so that it passes pixel centres of
    // the reduced image here and there.
    const int width = 160, height = 160;
    const float pixel = 2.0f * 6.0f * std::tan(glm::radians(25.0f)) / height;
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}), glowing({0.1f, 0.1f, 0.1f}));
    builder.add(quadMesh({-2, -1.5f, 0}, {4, 3, 0}, {0, 1.3f * pixel, 0}),
                glowing({0.9f, 0.2f, 0.1f}));
    const auto scene = builder.build();
    for (const int divider : {2, 4})
    {
        const Upsampled u = upsampled(scene, frontView(width, height), divider);
        int bar = 0, found = 0, wrong = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
            {
                const bool inBar = pixelOf(u.reference, x, y).x > 0.5f;
                bar += inBar;
                const bool same = isNear(pixelOf(u.image, x, y), pixelOf(u.reference, x, y));
                found += inBar && same;
                wrong += !inBar && !same;
            }
        CAPTURE(divider, bar, found);
        CHECK(bar > 80);
        CHECK(wrong == 0);
        CHECK(found >= 95 * bar / 100);
    }
}

TEST_CASE("upsampling: textures are as sharp as in a full-size image", "[session][upsample]")
{
    // The squares are white and black or nearly so, and two to three pixels of the reduced image
    // wide.
    for (const bool displayReferred : {false, true})
        for (const uint8_t dark : {40, 0})
        {
            SceneBuilder builder;
            builder.scene->displayReferred = displayReferred;
            auto texture = std::make_shared<Texture>();
            texture->width = texture->height = 2;
            texture->linearFilter = false;
            texture->bytes.assign(16, 255);
            for (const std::size_t texel : {0, 1, 2, 3})
                for (std::size_t c = 0; c < 3; ++c)
                    texture->bytes[4 * texel + c] = texel == 0 || texel == 3 ? 200 : dark;
            builder.scene->textures.push_back(texture);
            Material checks = lambert(Vec3(1.0f));
            checks.baseColorTexture = 0;
            auto mesh = quadMesh({-4, -4, 0}, {8, 0, 0}, {1, 8, 0});
            mesh->uvs = std::vector<Vec2>{{0, 0}, {8, 0}, {8, 8}, {0, 8}};
            builder.add(mesh, checks);
            builder.scene->lights.push_back(pointLight({-1, 1, 6}, Vec3(60.0f)));
            const Upsampled u = upsampled(builder.build(), frontView(160, 120), 4);
            const float grey = displayReferred ? 0.04f : 0.18f;
            int wrong = 0, bright = 0, black = 0;
            for (int y = 0; y < 120; ++y)
                for (int x = 0; x < 160; ++x)
                {
                    const float value = pixelOf(u.image, x, y).x,
                                expected = pixelOf(u.reference, x, y).x;
                    bright += expected > grey;
                    black += expected < grey;
                    wrong += std::abs(value - expected) > 0.1f * expected + 0.004f;
                }
            CAPTURE(displayReferred, int(dark), wrong);
            CHECK(bright > 7000);
            CHECK(black > (dark ? 0 : 7000));
            // Display values were lit before they were decoded: divided by the albedo they are the
            // light, except in sRGB's toe.
            CHECK(wrong <= 160 * 120 / (displayReferred ? 33 : 200));
        }
}

TEST_CASE("upsampling: curved surfaces are near those of a full-size image", "[session][upsample]")
{
    SceneBuilder builder;
    builder.add(sphereMesh({0, 0, 0}, 2.0f, 90), lambert(Vec3(0.8f)));
    builder.scene->lights.push_back(pointLight({3, 3, 6}));
    const View view = frontView(320, 320);
    const Upsampled u = upsampled(builder.build(), view, 4);
    CHECK(u.counts.traced < 320 * 320 * 2 / 3);
    // A pixel is 0.017 wide at the sphere; a length of depth changes the depth by about 0.1 / (z *
    // z), since the near plane is at 0.1.
    const double nearPlane = view.clipFromView[3][2] / (view.clipFromView[2][2] - 1.0);
    CHECK(largestDepthError(u) <= 0.25 * 0.0175 * nearPlane / (4.0 * 4.0));
}

TEST_CASE("upsampling: with too many edges less is traced, and nothing is black",
          "[session][upsample]")
{
    SceneBuilder builder;
    const Material same = glowing({0.3f, 0.6f, 0.1f});
    builder.add(quadMesh({-20, -20, -5}, {40, 0, 0}, {0, 40, 0}), same);
    for (int i = 0; i < 40; ++i)
        builder.add(
            quadMesh({-4.0f + 0.2f * static_cast<float>(i), -2, 0}, {0.1f, 0, 0}, {0.5f, 4, 0}),
            same);
    const View view = frontView(160, 120);
    View smaller = view;
    smaller.width = 40;
    smaller.height = 30;
    RenderSession session(std::make_shared<Workers>(2));
    const ResolvedImage small = centredImage(session, builder.build(), smaller);
    const std::vector<SurfaceSample> samples = session.surfaceSamples();
    std::vector<uint64_t> traced;
    for (const double most : {1.0, 0.55, 0.1})
    {
        ResolvedImage image;
        traced.push_back(session.upsample(small, samples, 160, 120, image, most).traced);
        CHECK(image.radiance.size() == 4 * 160 * 120);
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 160; ++x)
                if (pixelOf(image, x, y) != Vec4(0.3f, 0.6f, 0.1f, 1.0f))
                    FAIL_CHECK("at " << x << ", " << y);
    }
    CAPTURE(traced[0], traced[1], traced[2]);
    CHECK(traced[0] > traced[1]);
    CHECK(traced[1] > traced[2]);
    CHECK(traced[2] == 16 * (2 * (40 + 30) - 4)); // the blocks at the border
}

TEST_CASE("upsampling: of a blended layer the layer is what is seen, at edges, too", "[session]")
{
    // Half of the camera rays would pass the layer by chance, and meet another surface.
    SceneBuilder builder;
    Material pane = glowing(Vec3(0.2f, 0.6f, 1.0f));
    pane.alpha = 0.5f;
    pane.blended = true;
    builder.add(quadMesh({-1.1f, -1.3f, 1.0f}, {2.0f, 0.3f, 0.0f}, {-0.2f, 2.1f, 0.0f}), pane);
    builder.add(quadMesh({-8, -8, -1}, {16, 0, 0}, {0, 16, 0}), glowing(Vec3(1.0f, 0.5f, 0.1f)));
    const Upsampled u = upsampled(builder.build(), frontView(160, 120), 4);
    CHECK(u.counts.traced > 200);
    CHECK(u.counts.unlike == 0);
    for (const SurfaceSample& sample : u.samples)
        REQUIRE(sample.object != 0);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
        {
            CAPTURE(x, y);
            REQUIRE(isNear(pixelOf(u.image, x, y), pixelOf(u.reference, x, y)));
        }
}

TEST_CASE("upsampling: threads make no difference, nor does what the vectors held",
          "[session][upsample]")
{
    const auto scene = cornellBox().build();
    const Upsampled one = upsampled(scene, cornellView(150, 130), 3, 1);
    const Upsampled three = upsampled(scene, cornellView(150, 130), 3, 3);
    CHECK(one.image.radiance == three.image.radiance);
    CHECK(one.image.depth == three.image.depth);
    CHECK(one.counts.traced == three.counts.traced);
    CHECK(one.counts.unlike == three.counts.unlike);

    RenderSession session(std::make_shared<Workers>(2));
    View smaller = cornellView(150, 130);
    smaller.width = 50;
    smaller.height = 44;
    centredImage(session, scene, smaller);
    ResolvedImage again;
    again.radiance.assign(4 * 150 * 130, NAN);
    again.depth.assign(150 * 130, NAN);
    session.upsample(one.small, one.samples, 150, 130, again);
    CHECK(again.radiance == one.image.radiance);
    CHECK(again.depth == one.image.depth);

    const ToneMap toneMap{-0.5f, false};
    std::vector<uint8_t> expected(4 * 150 * 130), shown(4 * 150 * 130);
    std::vector<float> depth(150 * 130);
    presentImage(again, toneMap, Workers(1), expected.data(), nullptr);
    session.presentUpsampled(one.small, one.samples, 150, 130,
                             {toneMap, shown.data(), depth.data()});
    CHECK(shown == expected);
    CHECK(depth == again.depth);
    session.presentUpsampled(one.small, one.samples, 150, 130, {toneMap, shown.data(), nullptr});
    CHECK(shown == expected);
}

TEST_CASE("upsampling: images of a pixel or a row, and sessions without any", "[session][upsample]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), glowing({0.5f, 0.25f, 0.125f}));
    const auto scene = builder.build();
    for (const int width : {1, 2, 5, 33})
        for (const int height : {1, 3})
        {
            View view = frontView(100, 100);
            view.width = width;
            view.height = height;
            const Upsampled u = upsampled(scene, view, 8);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    CHECK(pixelOf(u.image, x, y) == Vec4(0.5f, 0.25f, 0.125f, 1.0f));
            CHECK(largestDepthError(u) <= 1e-6f);
        }
    RenderSession none(std::make_shared<Workers>(1));
    ResolvedImage result;
    result.width = 3;
    CHECK(none.upsample({}, {}, 10, 10, result).traced == 0);
    CHECK(result.width == 0);
}
