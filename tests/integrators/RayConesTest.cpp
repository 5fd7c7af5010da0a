// RayConesTest.cpp - textures are averaged over what a pixel sees, and only there.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/accel/MergeHits.h"
#include "osgRayTrace/integrators/shared/RayCones.h"
#include "osgRayTrace/shading/TextureMips.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr IntegratorKind kKinds[] = {IntegratorKind::Path, IntegratorKind::Whitted};

std::shared_ptr<Texture> noise(bool mips)
{
    Uniform random(5);
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 64;
    texture->decodeSrgb = true;
    for (int i = 0; i < 4 * 64 * 64; ++i)
        texture->bytes.push_back(static_cast<uint8_t>(255.99f * random()));
    if (mips) texture->mips = textureMips(*texture, true);
    return texture;
}

/// Returns a wall at z = 0 that shines with the texture, 16 repetitions along each side.
std::shared_ptr<Mesh> wall()
{
    const auto mesh = quadMesh({-8, -8, 0}, {16, 0, 0}, {0, 16, 0});
    mesh->uvs = std::vector<Vec2>{{0, 0}, {16, 0}, {16, 16}, {0, 16}};
    return mesh;
}

/// Returns a scene with the wall; the wall's material is number 0.
SceneBuilder wallScene(bool mips)
{
    SceneBuilder builder;
    builder.scene->textures = {noise(mips)};
    Material material = lamp(Vec3(1.0f));
    material.emissionTexture = 0;
    builder.add(wall(), material);
    return builder;
}

/// Returns the mean squared difference over the squared mean.
double relativeError(const Picture& a, const Picture& b)
{
    double squares = 0.0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
        {
            const glm::dvec3 off = glm::dvec3(a.at(x, y)) - glm::dvec3(b.at(x, y));
            squares += glm::dot(off, off) / 3.0;
        }
    const double mean = double(b.mean().y);
    return squares / (a.width * a.height * mean * mean);
}

/// share: of the error without mips that may be left.
void checkOnePass(const SceneBuilder& with, const SceneBuilder& without, const View& view,
                  double share = 0.1)
{
    for (const IntegratorKind kind : kKinds)
    {
        const RenderOptions options = optionsOf(kind);
        const Picture converged = render(without.build(), view, optionsOf(kind, 8, 1), 512);
        const double filtered = relativeError(render(with.build(), view, options, 1), converged);
        const double random = relativeError(render(without.build(), view, options, 1), converged);
        CAPTURE(int(kind), filtered, random);
        CHECK(random > 0.1); // the texels of a pixel differ
        CHECK(filtered < share * random);
    }
}

} // namespace

TEST_CASE("ray cones: footprints are the pixels of perspective and parallel views", "[integrators]")
{
    constexpr int kSize = 4;
    const View perspective = perspectiveView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90.0, kSize, kSize);
    View parallel = perspective;
    parallel.clipFromView = glm::ortho(-3.0, 3.0, -3.0, 3.0, 0.1, 10.0);
    for (const bool isParallel : {false, true})
        for (const float scale : {1.0f, 0.5f})
        {
            PassContext context;
            context.camera = *cameraRays(isParallel ? parallel : perspective, Vec3d(0.0));
            context.coneScale = scale;
            RayHitBlock rays;
            ConeLanes cones;
            SurfaceLanes surface;
            for (int i = 0; i < kLanes; ++i)
            {
                const float x = float(i % 4) + 0.5f, y = float(i / 4) + 0.5f;
                const CameraRays& c = context.camera;
                const Vec3 origin = c.origin + c.originDx * x + c.originDy * y;
                const Vec3 way = c.direction + c.directionDx * x + c.directionDy * y;
                const Vec3 direction = glm::normalize(way);
                setRay(rays.ray, i, plainOf(origin), plainOf(direction), 0.0f,
                       -origin.z / direction.z);
                setLane(surface.geometricNormal, i, Vec3(0.0f, 0.0f, 1.0f));
            }
            surface.hits = kAllLanes;
            cameraCones(context, rays.ray, cones);
            setFootprints(rays.ray, cones, surface);
            const double pixel = isParallel ? 6.0 / kSize : 10.0 / kSize; // 5 tan 45 to each side
            for (int i = 0; i < kLanes; ++i)
                CHECK(surface.footprint[i] == Approx(scale * pixel).epsilon(1e-5));

            moveCones(rays.ray, 0x00ffu, cones);
            for (int i = 0; i < kLanes; ++i)
                CHECK((cones.width[i] > 0.0f) == (i < 8));
            setFootprints(rays.ray, cones, surface); // as far again
            CHECK(surface.footprint[5] == Approx((isParallel ? 1.0 : 2.0) * scale * pixel));
            CHECK(surface.footprint[9] == 0.0f);
        }
}

TEST_CASE("ray cones: what is met behind a pane does not have the pane's footprint",
          "[integrators]")
{
    RayHitBlock rays, behind;
    SurfaceLanes surface, later;
    surface.hits = surface.coned = kAllLanes;
    later.hits = 0x0033u;
    mergeHits(behind, later, 0x00ffu, rays, surface);
    CHECK(surface.hits == (0xff33u & kAllLanes));
    CHECK(surface.coned == (0xff00u & kAllLanes));
}

TEST_CASE("ray cones: one pass over a distant texture is close to the converged picture",
          "[integrators]")
{
    const View view = perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 40.0, 32, 32);
    checkOnePass(wallScene(true), wallScene(false), view);
}

TEST_CASE("ray cones: mirrors and clear glass carry them on", "[integrators]")
{
    for (const bool isGlass : {false, true})
    {
        SceneBuilder with = wallScene(true), without = wallScene(false);
        for (SceneBuilder* builder : {&with, &without})
        {
            if (isGlass)
                builder->add(boxMesh({-8, -8, 2}, {8, 8, 2.2f}), glass(1.5f));
            else
                builder->add(quadMesh({-8, -8, 6}, {0, 16, 0}, {16, 0, 0}), mirror(Vec3(1.0f)));
        }
        const View ahead = perspectiveView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40.0, 32, 32);
        const View behind = perspectiveView({0, 0, 3}, {0, 0, 6}, {0, 1, 0}, 40.0, 32, 32);
        CAPTURE(isGlass);
        // Paths choose at random between what glass mirrors and what stands behind it.
        checkOnePass(with, without, isGlass ? ahead : behind, isGlass ? 0.25 : 0.1);
    }
}

TEST_CASE("ray cones: light that a texture sends to other surfaces is not averaged",
          "[integrators]")
{
    // Paths that leave the plaster read the image itself: the pictures are the same.
    const View view = perspectiveView({0, 0, 3}, {0, 0, 6}, {0, 1, 0}, 40.0, 16, 16);
    std::vector<Picture> pictures;
    for (const bool mips : {false, true})
    {
        SceneBuilder builder = wallScene(mips);
        builder.add(quadMesh({-8, -8, 6}, {0, 16, 0}, {16, 0, 0}), lambert(Vec3(0.5f)));
        pictures.push_back(render(builder.build(), view, optionsOf(IntegratorKind::Path), 4));
    }
    CHECK(pictures[0].rgba == pictures[1].rgba);
    CHECK(pictures[0].mean().y > 0.01f);
}

TEST_CASE("ray cones: the picture of many passes is that without mips", "[integrators]")
{
    // Texels are about as large as pixels, so that a mip would blur what the picture shows.
    const View view = perspectiveView({0, 0, 1.2}, {0, 0, 0}, {0, 1, 0}, 40.0, 32, 32);
    const RenderOptions options = optionsOf(IntegratorKind::Path);
    const Picture converged =
        render(wallScene(false).build(), view, optionsOf(IntegratorKind::Path, 8, 1), 1024);
    const auto error = [&](bool mips, int passes)
    { return relativeError(render(wallScene(mips).build(), view, options, passes), converged); };
    for (const int passes : {1, 4, 16, 64, 256})
    {
        const double with = error(true, passes), without = error(false, passes);
        CAPTURE(passes, with, without);
        // The blur falls faster than the noise; both are below 1e-3 in the end.
        CHECK(with < 1.5 * without + 1e-4);
        if (passes == 256) CHECK(with < 1e-3);
    }
}
