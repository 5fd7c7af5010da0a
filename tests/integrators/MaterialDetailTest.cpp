// MaterialDetailTest.cpp - normal maps, panes, attenuation and vertex colours in pictures. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

#include <glm/gtc/matrix_transform.hpp>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr IntegratorKind kKinds[] = {IntegratorKind::Path, IntegratorKind::Whitted};

Material withDetail(Material material, const MaterialDetail& detail)
{
    material.detail = std::make_shared<MaterialDetail>(detail);
    return material;
}

/// Returns a texture of one texel.
std::shared_ptr<const Texture> texel(Vec4 value)
{
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->floats = {value.x, value.y, value.z, value.w};
    return texture;
}

/// Returns the texel of a normal that is turned by an angle from the surface's towards s.
std::shared_ptr<const Texture> tiltedTexel(double degrees)
{
    const auto angle = static_cast<float>(degrees * M_PI / 180.0);
    return texel(Vec4(0.5f + 0.5f * std::sin(angle), 0.5f, 0.5f + 0.5f * std::cos(angle), 1.0f));
}

/// Returns a diffuse quad in the plane z = 0 with the normal map of texture 0.
std::shared_ptr<Mesh> mappedQuad(Vec2 alongX, Vec2 alongY)
{
    const auto mesh = quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    std::vector<Vec2> uvs;
    for (const Vec3& p : mesh->positions)
        uvs.push_back(alongX * (0.5f * p.x + 0.5f) + alongY * (0.5f * p.y + 0.5f));
    mesh->uvs = std::move(uvs);
    return mesh;
}

Material mappedMaterial(Material material, float scale = 1.0f)
{
    MaterialDetail detail;
    detail.textures[kNormalRole] = 0;
    detail.normalScale = scale;
    return withDetail(material, detail);
}

/// Returns a light that shines downwards and along x: it comes from (-1, 0, 1) or (1, 0, 1).
Light slanted(float x)
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = glm::normalize(Vec3(-x, 0.0f, -1.0f));
    light.diffuse = Vec3(1.0f);
    return light;
}

View fromAbove()
{
    return patchView({0, 0, 0}, {0, 0, 1}, 0.1, 8);
}

/// Returns the radiance of a white mapped quad in slanted light from the side of +x.
double litMap(const std::shared_ptr<Mesh>& mesh, const std::shared_ptr<const Texture>& texture,
              IntegratorKind kind, const Mat4* placed = nullptr)
{
    SceneBuilder builder;
    builder.scene->textures = {texture};
    const uint32_t instance = builder.add(mesh, mappedMaterial(lambert(Vec3(1.0f))));
    if (placed)
    {
        Instance& use = builder.scene->instances[instance];
        use.placed = true;
        use.engineFromLocal = {Mat3(*placed), Vec3((*placed)[3])};
        use.mirrored = glm::determinant(Mat3(*placed)) < 0.0f;
    }
    builder.addLight(slanted(1.0f));
    return double(render(builder.build(), fromAbove(), optionsOf(kind), 1).mean().y);
}

double cosineOf(double degrees)
{
    return std::cos(degrees * M_PI / 180.0);
}

} // namespace

TEST_CASE("normal map: bumps look the way that texture coordinates go, also mirrored",
          "[integrators]")
{
    const auto texture = tiltedTexel(30.0);
    const Vec2 s(1, 0), t(0, 1);
    for (const IntegratorKind kind : kKinds)
    {
        CAPTURE(int(kind));
        // The light is 45 degrees off the surface's normal, and 15 or 75 off the tilted one.
        CHECK(litMap(mappedQuad(s, t), texture, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(-s, t), texture, kind) == Approx(cosineOf(75.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(s, -t), texture, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
        // Where s goes along y, the tilt is out of the plane of the light.
        const double across = cosineOf(30.0) * cosineOf(45.0);
        CHECK(litMap(mappedQuad(t, s), texture, kind) == Approx(across).epsilon(1e-4));
        CHECK(litMap(mappedQuad({0, 0}, {0, 0}), texture, kind) ==
              Approx(cosineOf(45.0)).epsilon(1e-4)); // coordinates without area: no map
        // A tilt along t follows t, whatever the sense in which coordinates wind.
        const auto alongT = texel(Vec4(0.5f, 0.75f, 0.5f + 0.5f * float(cosineOf(30.0)), 1.0f));
        CHECK(litMap(mappedQuad(t, s), alongT, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(-t, s), alongT, kind) == Approx(cosineOf(75.0)).epsilon(1e-4));
        CHECK(litMap(mappedQuad(t, -s), alongT, kind) == Approx(cosineOf(15.0)).epsilon(1e-4));
    }
}

TEST_CASE("normal map: tangents of the mesh go before, and instances turn them", "[integrators]")
{
    const Vec2 s(1, 0), t(0, 1);
    const auto alongT = texel(Vec4(0.5f, 0.75f, 0.5f + 0.5f * float(cosineOf(30.0)), 1.0f));
    const auto withTangents = [&](Vec4 tangent)
    {
        const auto mesh = mappedQuad(s, t);
        mesh->tangents = std::vector<Vec4>(4, tangent);
        return mesh;
    };
    const auto path = IntegratorKind::Path;
    // The bitangent is w cross(normal, tangent): along +x for the tangent -y and w = 1.
    CHECK(litMap(withTangents({0, -3, 0, 1}), alongT, path) ==
          Approx(cosineOf(15.0)).epsilon(1e-4));
    CHECK(litMap(withTangents({0, -3, 0, -1}), alongT, path) ==
          Approx(cosineOf(75.0)).epsilon(1e-4));
    CHECK(litMap(withTangents({1, 0, 0, 1}), tiltedTexel(30.0), path) ==
          Approx(cosineOf(15.0)).epsilon(1e-4));

    const Mat4 half = glm::rotate(Mat4(1.0f), static_cast<float>(M_PI), Vec3(0, 0, 1));
    const Mat4 mirror = glm::scale(Mat4(1.0f), Vec3(-1, 1, 1));
    for (const auto& mesh : {mappedQuad(s, t), withTangents({1, 0, 0, 1})})
    {
        CHECK(litMap(mesh, tiltedTexel(30.0), path, &half) == Approx(cosineOf(75.0)).epsilon(1e-4));
        CHECK(litMap(mesh, tiltedTexel(30.0), path, &mirror) ==
              Approx(cosineOf(75.0)).epsilon(1e-4));
    }
    const auto turned = withTangents({0, -1, 0, 1}); // bitangent +x, which the mirror turns to -x
    CHECK(litMap(turned, alongT, path, &mirror) == Approx(cosineOf(75.0)).epsilon(1e-4));
}

TEST_CASE("normal map: no light comes through a surface, and mirrors have no black bumps",
          "[integrators]")
{
    for (const IntegratorKind kind : kKinds)
    {
        SceneBuilder builder;
        builder.scene->textures = {tiltedTexel(80.0)};
        builder.add(mappedQuad({1, 0}, {0, 1}), mappedMaterial(lambert(Vec3(1.0f))));
        Light below = slanted(1.0f);
        below.direction = glm::normalize(Vec3(-1.0f, 0.0f, 0.1f));
        builder.addLight(below);
        CHECK(render(builder.build(), fromAbove(), optionsOf(kind), 4).mean() == Vec3(0.0f));

        SceneBuilder room;
        room.scene->textures = {tiltedTexel(60.0)};
        room.add(boxMesh(Vec3(-3.0f), Vec3(3.0f)), lamp(Vec3(1.0f)));
        room.add(mappedQuad({1, 0}, {0, 1}), mappedMaterial(mirror(Vec3(1.0f))));
        for (const double x : {-2.0, 0.1, 2.0})
        {
            const View view = perspectiveView({x, 0.3, 1.0}, {0, 0, 0}, {0, 1, 0}, 20.0, 16, 16);
            CHECK(render(room.build(), view, optionsOf(kind), 1).mean().y ==
                  Approx(1.0).epsilon(1e-5));
        }
    }
}

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

TEST_CASE("panes: in a white room they cannot be seen, and no light counts twice",
          "[integrators][statistics]")
{
    MaterialDetail thin;
    thin.thinWalled = true;
    for (const bool sampled : {false, true})
    {
        SceneBuilder builder;
        const auto room = boxMesh(Vec3(-3.0f), Vec3(3.0f));
        if (sampled)
            builder.addEmissive(room, lamp(Vec3(1.0f)));
        else
            builder.add(room, lamp(Vec3(1.0f)));
        builder.add(quadMesh({-2, -2, 0.5f}, {4, 0, 0}, {0, 4, 0}), withDetail(glass(1.5f), thin));
        Material white = lambert(Vec3(1.0f));
        builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), white);
        const View view = perspectiveView({0.3, -1.0, 2.0}, {0, 0, 0}, {0, 1, 0}, 20.0, 16, 16);
        const Estimate radiance =
            measure(builder.build(), view, optionsOf(IntegratorKind::Path, 60), 64);
        CAPTURE(sampled, radiance.mean(), radiance.standardError());
        CHECK(radiance.agrees(1.0, 1e-3));
        CHECK(radiance.standardError() < 0.01);
    }
}

TEST_CASE("panes: light of lamps without area passes them straight, tinted by 1 - F",
          "[integrators]")
{
    MaterialDetail thin;
    thin.thinWalled = true;
    Material green = glass(1.5f);
    green.baseColor = Vec3(0.25f, 1.0f, 0.5f);
    const auto lit = [&](bool pane, IntegratorKind kind, bool classic)
    {
        SceneBuilder builder;
        Material floor = lambert(Vec3(0.5f));
        if (classic)
        {
            floor = Material();
            floor.diffuse = Vec3(0.5f);
            floor.ambient = Vec3(0.0f);
        }
        builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), floor);
        if (pane)
            builder.add(quadMesh({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}), withDetail(green, thin));
        Light light = slanted(0.0f);
        builder.addLight(light);
        const View view = perspectiveView({0.0, -0.5, 0.5}, {0, 0, 0}, {0, 0, 1}, 5.0, 4, 4);
        return render(builder.build(), view, optionsOf(kind, 1), 1).mean();
    };
    const double passed = (1.0 - 0.04) / (1.0 + 0.04);
    for (const IntegratorKind kind : kKinds)
        for (const bool classic : {false, true})
        {
            const Vec3 open = lit(false, kind, classic), behind = lit(true, kind, classic);
            CAPTURE(int(kind), classic);
            REQUIRE(open.y > 0.1f);
            CHECK(behind.y == Approx(open.y * passed).epsilon(1e-4));
            CHECK(behind.x == Approx(open.x * passed * 0.25).epsilon(1e-4));
            CHECK(behind.z == Approx(open.z * passed * 0.5).epsilon(1e-4));
        }
}

TEST_CASE("panes: photons and paths find the same light behind them",
          "[integrators][statistics][long]")
{
    MaterialDetail thin;
    thin.thinWalled = true;
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({-1, -1, 0}, {0, 2, 0}, {0, 0, 2}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({-1.5f, -1.5f, 1}, {3, 0, 0}, {0, 3, 0}), withDetail(glass(1.5f), thin));
    builder.addQuadLight({-0.3f, 0.3f, 1.9f}, {0.6f, 0, 0}, {0, -0.6f, 0}, Vec3(5.0f));
    const auto scene = builder.build();
    const View view = perspectiveView({0.9, -0.9, 0.8}, {-0.5, 0.2, 0.2}, {0, 0, 1}, 40.0, 24, 24);
    const Estimate paths = measure(scene, view, optionsOf(IntegratorKind::Path), 64);
    CHECK(paths.mean() > 0.05);
    for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
    {
        RenderOptions options = optionsOf(kind);
        options.photons = 20000;
        const Estimate photons = measure(scene, view, options, 16);
        CAPTURE(int(kind), paths.mean(), photons.mean());
        const double spread = 4.0 * std::hypot(paths.standardError(), photons.standardError());
        CHECK(std::abs(paths.mean() - photons.mean()) < spread + 0.02 * paths.mean());
    }
}

TEST_CASE("attenuation: light that crosses a body falls by Beer's law", "[integrators]")
{
    MaterialDetail detail;
    detail.attenuationColor = Vec3(0.5f, 0.25f, 1.0f);
    detail.attenuationDistance = 4.0f;
    for (const double unit : {1.0, 2.0})
        for (const IntegratorKind kind : kKinds)
        {
            SceneBuilder builder;
            builder.scene->unit = unit; // the distance is in the world's lengths
            builder.add(boxMesh({-1, -1, 1}, {1, 1, 3}), withDetail(glass(1.0f), detail));
            builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lamp(Vec3(8.0f)));
            const View view = patchView({0, 0, 4.0 * unit}, {0, 0, 1}, 0.01, 4);
            const Vec3 seen = render(builder.build(), view, optionsOf(kind), 1).mean();
            const double share = 2.0 * unit / 4.0;
            CAPTURE(int(kind), unit);
            CHECK(seen.x == Approx(8.0 * std::pow(0.5, share)).epsilon(1e-4));
            CHECK(seen.y == Approx(8.0 * std::pow(0.25, share)).epsilon(1e-4));
            CHECK(seen.z == Approx(8.0).epsilon(1e-4));
        }
}

TEST_CASE("attenuation: photons lose what paths lose", "[integrators][statistics][long]")
{
    MaterialDetail detail;
    detail.attenuationColor = Vec3(0.3f);
    detail.attenuationDistance = 0.5f;
    const auto scene = [&](bool absorbs)
    {
        SceneBuilder builder;
        builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.7f)));
        const Material body = absorbs ? withDetail(glass(1.5f), detail) : glass(1.5f);
        builder.add(boxMesh({-0.5f, -0.5f, 0.4f}, {0.5f, 0.5f, 0.9f}), body);
        builder.addQuadLight({-0.5f, 0.5f, 1.9f}, {1, 0, 0}, {0, -1, 0}, Vec3(5.0f));
        return builder.build();
    };
    const View view = perspectiveView({0.9, -0.9, 0.35}, {0, 0, 0}, {0, 0, 1}, 40.0, 24, 24);
    const Estimate clear = measure(scene(false), view, optionsOf(IntegratorKind::Path, 12), 64);
    const Estimate paths = measure(scene(true), view, optionsOf(IntegratorKind::Path, 12), 64);
    CHECK(paths.mean() < 0.95 * clear.mean());
    RenderOptions options = optionsOf(IntegratorKind::PhotonCaustics, 12);
    options.photons = 20000;
    const Estimate photons = measure(scene(true), view, options, 16);
    CAPTURE(clear.mean(), paths.mean(), photons.mean());
    const double spread = 4.0 * std::hypot(paths.standardError(), photons.standardError());
    CHECK(std::abs(paths.mean() - photons.mean()) < spread + 0.02 * paths.mean());
}

TEST_CASE("vertex colours multiply base colour and alpha, and places move textures",
          "[integrators]")
{
    MaterialDetail detail;
    detail.vertexColors = true;
    detail.places[kBaseColorRole].set = 1;
    detail.places[kBaseColorRole].u = Vec2(0.0f); // the texel at 0.75 everywhere
    detail.places[kBaseColorRole].v = Vec2(0.0f);
    detail.places[kBaseColorRole].offset = Vec2(0.75f, 0.5f);
    auto stripes = std::make_shared<Texture>();
    stripes->width = 2;
    stripes->height = 1;
    stripes->linearFilter = false;
    stripes->floats = {1, 1, 1, 1, 0.5f, 1.0f, 1.0f, 1.0f};
    for (const bool blended : {false, true})
    {
        SceneBuilder builder;
        builder.scene->textures = {stripes};
        const auto mesh = quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
        mesh->colors = std::vector<Vec4>(4, Vec4(0.5f, 0.25f, 1.0f, 0.0f));
        Material material = withDetail(lambert(Vec3(0.8f)), detail);
        material.baseColorTexture = 0;
        material.blended = blended; // alpha 0: nothing is left of it
        builder.add(mesh, material);
        builder.addLight(slanted(0.0f));
        for (const IntegratorKind kind : kKinds)
        {
            const Vec3 seen = render(builder.build(), fromAbove(), optionsOf(kind), 1).mean();
            CAPTURE(int(kind), blended);
            const Vec3 expected = blended ? Vec3(0.0f) : Vec3(0.2f, 0.2f, 0.8f);
            CHECK(glm::length(seen - expected) < 1e-5f);
        }
    }
}
