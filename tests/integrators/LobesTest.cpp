// LobesTest.cpp - brushed metal and leaves in pictures. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MaterialDetails.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the radiance of a brushed white metal in slanted light from the side of +x, seen from
/// above, or from below if the light comes from there.
double litBrushed(const std::shared_ptr<Mesh>& mesh, double rotation, IntegratorKind kind,
                  const std::shared_ptr<const Texture>& texture = {})
{
    MaterialDetail brushed;
    brushed.anisotropy = 0.5f;
    brushed.anisotropyRotation = static_cast<float>(rotation);
    if (texture) brushed.textures[kAnisotropyRole] = 0;
    Material metal = mirror(Vec3(1.0f));
    metal.roughness = 0.6f;
    SceneBuilder builder;
    if (texture) builder.scene->textures = {texture};
    builder.add(mesh, withDetail(metal, brushed));
    builder.addLight(slanted(1.0f));
    return double(render(builder.build(), fromAbove(), optionsOf(kind), 1).mean().y);
}

/// Returns pi f cos for light 45 degrees off the normal, in whose plane facets have the one width,
/// and the other across [Heitz18, eq. 1 and 2].
double brushedLight(double width, double other)
{
    const double half = M_PI / 8.0, x = std::sin(half) / width, z = std::cos(half);
    const double d = 1.0 / (M_PI * width * other * std::pow(x * x + z * z, 2));
    const double lambda = 0.5 * (std::sqrt(1.0 + width * width) - 1.0);
    return M_PI * d / (4.0 * (1.0 + lambda));
}

} // namespace

TEST_CASE("anisotropy: reflections are stretched along the texture's direction", "[integrators]")
{
    const double across = 0.36, along = across + (1.0 - across) * 0.25;
    const double stretched = brushedLight(along, across), narrow = brushedLight(across, along);
    REQUIRE(std::abs(stretched / narrow - 1.0) > 0.1);
    const Vec2 s(1, 0), t(0, 1);
    const double quarter = 0.5 * M_PI;
    for (const IntegratorKind kind : kKinds)
    {
        CAPTURE(int(kind));
        CHECK(litBrushed(mappedQuad(s, t), 0.0, kind) == Approx(stretched).epsilon(1e-4));
        CHECK(litBrushed(mappedQuad(t, s), 0.0, kind) == Approx(narrow).epsilon(1e-4));
        CHECK(litBrushed(mappedQuad(s, t), quarter, kind) == Approx(narrow).epsilon(1e-4));
        CHECK(litBrushed(mappedQuad(t, s), quarter, kind) == Approx(stretched).epsilon(1e-4));
        // The tangent is turned by 45 degrees to one side or, mirrored, to the other: each time the
        // bitangent is on the side of the light.
        const auto diagonal = [&](Vec2 u, Vec2 v, double turn)
        { return litBrushed(mappedQuad(u, v), turn, kind); };
        const Vec2 slant = glm::normalize(Vec2(1, 1)), other = glm::normalize(Vec2(-1, 1));
        CHECK(diagonal(slant, other, 0.5 * quarter) == Approx(stretched).epsilon(1e-4));
        CHECK(diagonal(slant, other, -0.5 * quarter) == Approx(narrow).epsilon(1e-4));
        CHECK(diagonal(slant, -other, 0.5 * quarter) == Approx(stretched).epsilon(1e-4));
        // The texture turns the direction, and its blue is a factor of the strength.
        const auto upwards = texel(Vec4(0.5f, 1.0f, 1.0f, 1.0f));
        CHECK(litBrushed(mappedQuad(s, t), 0.0, kind, upwards) == Approx(narrow).epsilon(1e-4));
        const auto none = texel(Vec4(1.0f, 0.5f, 0.0f, 1.0f));
        const double round = brushedLight(across, across);
        CHECK(litBrushed(mappedQuad(s, t), 0.0, kind, none) == Approx(round).epsilon(1e-4));
        CHECK(litBrushed(mappedQuad({0, 0}, {0, 0}), 0.0, kind) == Approx(round).epsilon(1e-4));
        const auto tangents = mappedQuad(s, t);
        tangents->tangents = std::vector<Vec4>(4, Vec4(0, 2, 0, 1));
        CHECK(litBrushed(tangents, 0.0, kind) == Approx(narrow).epsilon(1e-4));
    }
}

TEST_CASE("diffuse transmission: a leaf shines by light from behind", "[integrators]")
{
    MaterialDetail leaf;
    leaf.diffuseTransmission = 0.75f;
    leaf.diffuseTransmissionColor = Vec3(0.5f, 1.0f, 0.25f);
    Material green = lambert(Vec3(0.8f));
    green.ior = 1.0f;
    for (const IntegratorKind kind : kKinds)
        for (const float height : {1.0f, -1.0f})
        {
            SceneBuilder builder;
            builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), withDetail(green, leaf));
            Light light = slanted(0.0f);
            light.direction = Vec3(0, 0, -height);
            builder.addLight(light);
            const Vec3 seen = render(builder.build(), fromAbove(), optionsOf(kind), 1).mean();
            CAPTURE(int(kind), height);
            const Vec3 lit = height > 0.0f ? Vec3(0.2f) : 0.75f * leaf.diffuseTransmissionColor;
            CHECK(glm::length(seen - lit) < 1e-5f);
        }
}

TEST_CASE("lobes: photons and paths find the same light", "[integrators][statistics][long]")
{
    // A leaf below a lamp is seen from below; a wall above a lamp is lit by brushed metal alone.
    MaterialDetail leaf, brushed;
    leaf.diffuseTransmission = 0.7f;
    brushed.anisotropy = 0.9f;
    Material metal = mirror(Vec3(0.9f));
    metal.roughness = 0.4f;
    for (const bool below : {true, false})
    {
        SceneBuilder builder;
        if (below)
            builder.add(quadMesh({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}),
                        withDetail(lambert(Vec3(0.6f)), leaf));
        else
            builder.add(mappedQuad({1, 0}, {0, 1}), withDetail(metal, brushed));
        builder.add(quadMesh({-1, -1, 0}, {0, 2, 0}, {0, 0, 4}), lambert(Vec3(0.7f)));
        builder.addQuadLight({-0.3f, 0.3f, 1.9f}, {0.6f, 0, 0}, {0, -0.6f, 0}, Vec3(5.0f));
        const auto scene = builder.build();
        const Vec3d eye = below ? Vec3d(0.5, 0, 0.1) : Vec3d(1.5, 0, 2.5);
        const Vec3d at = below ? Vec3d(-0.1, 0.1, 1) : Vec3d(-1, 0, 2.5);
        const View view = perspectiveView(eye, at, {0, 1, 0}, 30.0, 24, 24);
        const Estimate paths = measure(scene, view, optionsOf(IntegratorKind::Path), 64);
        RenderOptions options = optionsOf(IntegratorKind::Sppm);
        options.photons = 20000;
        const Estimate photons = measure(scene, view, options, 16);
        CAPTURE(below, paths.mean(), photons.mean());
        CHECK(paths.mean() > 0.001);
        const double spread = 4.0 * std::hypot(paths.standardError(), photons.standardError());
        CHECK(spread < 0.05 * paths.mean());
        CHECK(std::abs(paths.mean() - photons.mean()) < spread + 0.02 * paths.mean());
    }
}
