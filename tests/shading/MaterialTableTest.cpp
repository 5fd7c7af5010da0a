// MaterialTableTest.cpp - material descriptions become the surfaces that they describe.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/scene/Bodies.h"
#include "osgRayTrace/scene/SceneTraits.h"
#include "osgRayTrace/shading/Bsdf.h"
#include "osgRayTrace/shading/Fresnel.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Scene sceneOf(const Material& material)
{
    Scene scene;
    scene.materials = {material};
    return scene;
}

Bsdf bsdfOf(const Material& material, const MaterialPoint& point = {})
{
    const Scene scene = sceneOf(material);
    return MaterialTable(scene).bsdf(0, point);
}

std::shared_ptr<Texture> constantTexture(Vec4 color)
{
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->floats = {color.x, color.y, color.z, color.w};
    return texture;
}

} // namespace

TEST_CASE("material: a Lambert surface is diffuse and nothing else", "[shading]")
{
    const Scene scene = sceneOf(lambert(Vec3(0.1f, 0.2f, 0.3f)));
    const MaterialTable table(scene);
    CHECK(table[0].plainDiffuse);
    CHECK(table[0].constant);
    CHECK_FALSE(table[0].emits);
    CHECK_FALSE(table[0].fixedFunction);
    CHECK(table[0].front.diffuse == Vec3(0.1f, 0.2f, 0.3f));
    CHECK(table[0].front.isDiffuse());
}

TEST_CASE("material: glossy is what scatters by narrow lobes alone, seen from both sides",
          "[shading]")
{
    const auto isGlossy = [](const Material& material)
    {
        const Scene scene = sceneOf(material);
        const MaterialTable table(scene);
        CHECK(table[0].front.isGlossy() == table[0].back.isGlossy());
        return table[0].front.isGlossy();
    };
    Material metal = mirror(Vec3(0.9f));
    CHECK_FALSE(isGlossy(metal));
    metal.roughness = 0.04f; // alpha 0.0016
    CHECK(isGlossy(metal));
    metal.roughness = 0.49f;
    CHECK(isGlossy(metal));
    metal.roughness = 0.51f;
    CHECK_FALSE(isGlossy(metal));
    CHECK_FALSE(isGlossy(glass(1.5f)));
    CHECK(isGlossy(glass(1.5f, 0.3f)));
    CHECK_FALSE(isGlossy(lambert(Vec3(0.5f))));
    Material plastic = lambert(Vec3(0.5f));
    plastic.ior = 1.5f;
    plastic.roughness = 0.3f;
    CHECK_FALSE(isGlossy(plastic));
    Material frosted = glass(1.5f, 0.3f);
    frosted.transmission = 0.5f;
    CHECK_FALSE(isGlossy(frosted));

    MaterialDetail coat;
    coat.clearcoat = 1.0f;
    for (const float base : {0.0f, 0.3f, 0.6f})
        for (const float coated : {0.0f, 0.3f, 0.6f})
        {
            metal.roughness = base;
            coat.clearcoatRoughness = coated;
            metal.detail = std::make_shared<MaterialDetail>(coat);
            CAPTURE(base, coated);
            CHECK(isGlossy(metal) == (base < 0.5f && coated < 0.5f && base + coated > 0.0f));
        }
    MaterialDetail sheen;
    sheen.sheenColor = Vec3(0.5f);
    sheen.sheenRoughness = 0.3f;
    metal.roughness = 0.3f;
    metal.detail = std::make_shared<MaterialDetail>(sheen);
    CHECK_FALSE(isGlossy(metal));
}

TEST_CASE("material: metallic, roughness and base colour as in glTF", "[shading]")
{
    Material material = lambert(Vec3(0.8f, 0.4f, 0.2f));
    material.ior = 1.5f;
    material.metallic = 1.0f;
    material.roughness = 0.5f;
    Bsdf metal = bsdfOf(material);
    CHECK(metal.diffuse == Vec3(0.0f));
    CHECK(metal.reflectance == material.baseColor);
    CHECK(metal.grazing == 1.0f);
    CHECK(metal.coat == 0.0f);
    CHECK(metal.alpha == 0.25f);
    material.metallic = 0.0f;
    Bsdf plastic = bsdfOf(material);
    CHECK(plastic.diffuse == material.baseColor);
    CHECK(plastic.reflectance == Vec3(0.0f));
    CHECK(plastic.coat == 1.0f);
    CHECK(plastic.eta == 1.5f);
    CHECK(plastic.coatAverage == Approx(0.091778).margin(1e-4));
    material.baseColor = Vec3(5.0f);
    material.roughness = 3.0f;
    CHECK(bsdfOf(material).diffuse == Vec3(1.0f)); // clamped to its range
    CHECK(bsdfOf(material).alpha == 1.0f);
}

TEST_CASE("material: glass has its index inverted from inside, an opaque body has not", "[shading]")
{
    MaterialPoint inside;
    inside.front = false;
    CHECK(bsdfOf(glass(1.5f)).eta == 1.5f);
    CHECK(bsdfOf(glass(1.5f), inside).eta == Approx(1.0 / 1.5));
    CHECK(bsdfOf(glass(1.5f), inside).coatAverage == Approx(0.596346).margin(1e-4));
    CHECK(bsdfOf(glass(1.5f)).transmission == Vec3(1.0f));
    CHECK(bsdfOf(glass(1.5f)).diffuse == Vec3(0.0f));
    Material opaque = lambert(Vec3(0.5f));
    opaque.ior = 1.5f;
    CHECK(bsdfOf(opaque, inside).eta == 1.5f);
}

TEST_CASE("material: textures multiply the physical factors", "[shading]")
{
    Material material = lambert(Vec3(0.5f));
    material.ior = 1.5f;
    material.metallic = 0.5f;
    material.roughness = 0.8f;
    material.emission = Vec3(2.0f);
    material.baseColorTexture = 0;
    material.metallicRoughnessTexture = 1;
    material.emissionTexture = 2;
    Scene scene = sceneOf(material);
    scene.textures = {constantTexture({0.5f, 1.0f, 0.0f, 1.0f}),
                      constantTexture({0.9f, 0.5f, 0.2f, 1.0f}),
                      constantTexture({1.0f, 0.5f, 0.25f, 1.0f})};
    const MaterialTable table(scene);
    CHECK_FALSE(table[0].constant);
    CHECK(table[0].emits);
    const Bsdf bsdf = table.bsdf(0, {});
    CHECK(bsdf.alpha == Approx(0.16));  // (0.8 * G)^2
    CHECK(bsdf.grazing == Approx(0.1)); // 0.5 * B
    CHECK(bsdf.reflectance.x == Approx(0.1 * 0.25));
    CHECK(bsdf.diffuse.y == Approx(0.9 * 0.5));
    CHECK(table.emission(0, {}) == Vec3(2.0f, 1.0f, 0.5f));
}

TEST_CASE("material: texels that are no metal make a rough dielectric of a metal", "[shading]")
{
    Material factor = lambert(Vec3(0.9f));
    factor.ior = 1.5f;
    factor.roughness = 0.6f;
    Material texel = factor;
    texel.metallic = 1.0f; // as glTF has it unless told otherwise
    texel.metallicRoughnessTexture = 0;
    Scene scene = sceneOf(texel);
    scene.textures = {constantTexture({1.0f, 1.0f, 0.0f, 1.0f})};
    const MaterialTable table(scene);
    const Bsdf textured = table.bsdf(0, {}), plain = bsdfOf(factor);
    for (const float cosO : {0.05f, 0.4f, 1.0f})
    {
        for (const float cosI : {0.1f, 0.7f})
        {
            CAPTURE(cosO, cosI);
            const Vec3 wo(std::sqrt(1.0f - cosO * cosO), 0.0f, cosO),
                wi(0.0f, std::sqrt(1.0f - cosI * cosI), cosI);
            CHECK(evalBsdf(textured, wo, wi).fCos.x ==
                  Approx(evalBsdf(plain, wo, wi).fCos.x).epsilon(1e-5));
        }
    }
}

TEST_CASE("material: glass by texels under a metallic factor of 1 is glass", "[shading]")
{
    Material textured = glass(1.5f);
    textured.metallic = 1.0f;
    CHECK_FALSE(enclosesBody(textured));
    CHECK_FALSE(sceneTraits(sceneOf(textured)).transmission);
    textured.metallicRoughnessTexture = 0;
    CHECK(enclosesBody(textured));
    CHECK(sceneTraits(sceneOf(textured)).transmission);

    MaterialDetail detail;
    detail.thinWalled = true;
    textured.detail = std::make_shared<MaterialDetail>(detail);
    Scene scene = sceneOf(textured);
    scene.textures = {constantTexture({1.0f, 1.0f, 0.0f, 1.0f})};
    CHECK(MaterialTable(scene)[0].pane);
}

TEST_CASE("material: the image of a fixed-function material", "[shading]")
{
    Material material;
    material.diffuse = Vec3(0.6f, 0.4f, 0.2f);
    CHECK(bsdfOf(material).isDiffuse());
    CHECK(bsdfOf(material).diffuse == material.diffuse);
    material.specular = Vec3(0.5f);
    material.shininess = 30.0f;
    const Bsdf shiny = bsdfOf(material);
    CHECK(shiny.alpha == Approx(0.25)); // sqrt(2 / 32)
    CHECK(shiny.reflectance.x == Approx(0.5 * 8.0 / 32.0).epsilon(0.1));
    CHECK(shiny.grazing == shiny.reflectance.x);
    CHECK(shiny.diffuse.x == Approx(0.6 + 0.5 * 3.0 / 32.0 / (30.0 * 30.0)));
    material.lit = false;
    const Scene scene = sceneOf(material);
    const MaterialTable table(scene);
    CHECK(table[0].emits);
    CHECK_FALSE(table[0].plainDiffuse);
    CHECK(table.emission(0, {}) == material.diffuse);
    CHECK(table.bsdf(0, {}).isDiffuse());
    CHECK(table.bsdf(0, {}).diffuse == Vec3(0.0f));
}

// OpenGL's highlight of a directional light at the eye is cos^shininess; its mean over the disc of
// a sphere is 2 / (shininess + 2).
TEST_CASE("material: highlights are as bright on average as OpenGL's", "[shading]")
{
    for (const float shininess : {0.0f, 0.5f, 1.0f, 5.0f, 12.5f, 50.0f, 128.0f})
    {
        Material material;
        material.diffuse = Vec3(0.0f);
        material.specular = Vec3(0.25f, 0.125f, 0.0f);
        material.shininess = shininess;
        const Bsdf bsdf = bsdfOf(material);
        constexpr int kRings = 20000;
        double red = 0.0, green = 0.0;
        for (int i = 0; i < kRings; ++i)
        {
            const double cosine = (i + 0.5) / kRings;
            const Vec3 w(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
            const Vec3 radiance = evalBsdf(bsdf, w, w).fCos * kPi; // for an irradiance of pi
            red += 2.0 * cosine * radiance.x / kRings;
            green += 2.0 * cosine * radiance.y / kRings;
        }
        CAPTURE(shininess);
        CHECK(red == Approx(0.25 * 2.0 / (shininess + 2.0)).epsilon(0.01));
        CHECK(green == Approx(0.5 * red).epsilon(0.01));
    }
}

TEST_CASE("material: a highlight leaves the diffuse colour alone", "[shading]")
{
    for (const float base : {0.0f, 0.2f, 0.75f, 0.95f, 1.0f})
    {
        for (const float specular : {0.0f, 0.1f, 0.75f, 1.0f})
        {
            for (const float shininess : {0.0f, 1.0f, 5.0f, 20.0f, 128.0f})
            {
                Material material;
                material.diffuse = Vec3(base, 0.5f * base, 0.0f);
                material.specular = Vec3(specular, specular, 0.0f);
                material.shininess = shininess;
                const Bsdf bsdf = bsdfOf(material);
                const float broad = 1.0f / std::max(shininess, 1.0f);
                const float wide = specular * 3.0f / (shininess + 2.0f) * broad * broad;
                const Vec3 diffuse = material.diffuse + Vec3(wide, wide, 0.0f);
                CAPTURE(base, specular, shininess);
                CHECK(bsdf.diffuse.x >= std::min(base, 0.96f) - 1e-6f); // left by an index of 1.5
                CHECK(bsdf.diffuse.y * diffuse.x == Approx(bsdf.diffuse.x * diffuse.y));
                CHECK((specular == 0.0f || shininess <= 1.0f || bsdf.grazing >= 0.001f));
                CHECK(bsdf.grazing == Approx(std::max(bsdf.reflectance.x, bsdf.reflectance.y)));
                CHECK(bsdf.diffuse.x + bsdf.grazing <= 1.000001f); // no energy is gained
                if (base + specular * 4.0f <= 1.0f)
                    CHECK(glm::length(bsdf.diffuse - diffuse) < 1e-6f);
            }
        }
    }
}

TEST_CASE("material: a highlight of exponent 1 is a Lambert lobe beside the diffuse one",
          "[shading]")
{
    Material material;
    material.diffuse = Vec3(0.25f, 0.5f, 0.0f);
    material.specular = Vec3(0.5f, 0.25f, 0.125f);
    material.shininess = 1.0f;
    CHECK(bsdfOf(material).isDiffuse());
    CHECK(bsdfOf(material).diffuse == material.diffuse + material.specular);
    material.diffuse = Vec3(1.0f, 0.75f, 0.5f);
    CHECK(bsdfOf(material).isDiffuse());
    CHECK(glm::length(bsdfOf(material).diffuse - Vec3(1.0f, 1.0f / 1.5f, 0.625f / 1.5f)) < 1e-6f);
}

TEST_CASE("material: textures tint highlights as OpenGL does", "[shading]")
{
    Material material;
    material.diffuse = Vec3(0.5f);
    material.specular = Vec3(0.25f);
    material.shininess = 30.0f;
    const float plain = bsdfOf(material).reflectance.x;
    material.baseColorTexture = 0;
    Scene scene = sceneOf(material);
    scene.textures = {constantTexture({0.5f, 0.25f, 1.0f, 0.75f})};
    const auto highlight = [&](TextureEnvironment environment, bool separate)
    {
        scene.materials[0].textureEnvironment = environment;
        scene.materials[0].separateSpecular = separate;
        return MaterialTable(scene).bsdf(0, {}).reflectance;
    };
    const auto near = [plain](Vec3 color, Vec3 tint)
    { return glm::length(color - plain * tint) < 1e-6f; };
    CHECK(near(highlight(TextureEnvironment::Modulate, false), Vec3(0.5f, 0.25f, 1.0f)));
    CHECK(near(highlight(TextureEnvironment::Decal, false), Vec3(0.25f)));
    CHECK(near(highlight(TextureEnvironment::Blend, false), Vec3(0.5f, 0.75f, 0.0f)));
    CHECK(near(highlight(TextureEnvironment::Replace, false), Vec3(0.0f)));
    CHECK(near(highlight(TextureEnvironment::Modulate, true), Vec3(1.0f)));
    scene.materials[0].separateSpecular = false;
    CHECK_FALSE(MaterialTable(scene)[0].sameLobes); // a texel may be black
}

TEST_CASE("material: vertex colours replace what OpenGL lets them replace", "[shading]")
{
    Material material;
    material.ambient = Vec3(0.1f);
    material.diffuse = Vec3(0.2f);
    material.specular = Vec3(0.3f);
    material.emission = Vec3(0.4f);
    const Vec4 color(0.9f, 0.8f, 0.7f, 0.6f);
    const auto with = [&](VertexColorUse use)
    {
        material.vertexColorUse = use;
        return fixedFunctionColors(material, color);
    };
    const Vec3 rgb(color);
    CHECK(with(VertexColorUse::None).diffuse == Vec3(0.2f));
    CHECK(with(VertexColorUse::None).alpha == 1.0f);
    CHECK(with(VertexColorUse::Ambient).ambient == rgb);
    CHECK(with(VertexColorUse::Ambient).diffuse == Vec3(0.2f));
    CHECK(with(VertexColorUse::Diffuse).diffuse == rgb);
    CHECK(with(VertexColorUse::Diffuse).alpha == 0.6f);
    CHECK(with(VertexColorUse::Specular).specular == rgb);
    CHECK(with(VertexColorUse::Emission).emission == rgb);
    CHECK(with(VertexColorUse::AmbientAndDiffuse).ambient == rgb);
    CHECK(with(VertexColorUse::AmbientAndDiffuse).diffuse == rgb);
    material.lit = false;
    CHECK(with(VertexColorUse::AmbientAndDiffuse).diffuse == rgb);
}

TEST_CASE("material: texture environments", "[shading]")
{
    const Vec4 lit(0.8f, 0.4f, 0.2f, 0.5f), texture(0.5f, 0.5f, 1.0f, 0.25f);
    TextureTerms::Term term;
    term.value = texture;
    term.environmentColor = Vec4(0.0f, 1.0f, 0.0f, 1.0f);
    const auto applied = [&](TextureEnvironment environment)
    {
        term.environment = environment;
        return applyTextureEnvironment(term, lit);
    };
    CHECK(applied(TextureEnvironment::Modulate) == lit * texture);
    CHECK(applied(TextureEnvironment::Replace) == texture);
    const Vec4 decal = applied(TextureEnvironment::Decal);
    CHECK(decal.x == Approx(0.8 * 0.75 + 0.5 * 0.25));
    CHECK(decal.w == 0.5f);
    const Vec4 blend = applied(TextureEnvironment::Blend);
    CHECK(blend.x == Approx(0.4));
    CHECK(blend.y == Approx(0.7));
    CHECK(blend.z == Approx(0.0).margin(1e-6));
    CHECK(blend.w == Approx(0.125));
    const Vec4 add = applied(TextureEnvironment::Add);
    CHECK(add.x == Approx(1.3));
    CHECK(add.w == Approx(0.125));

    term.hasColor = false; // an alpha texture
    CHECK(applied(TextureEnvironment::Modulate) == Vec4(Vec3(lit), 0.125f));
    CHECK(applied(TextureEnvironment::Replace) == Vec4(Vec3(lit), 0.25f));
    CHECK(applied(TextureEnvironment::Add) == Vec4(Vec3(lit), 0.125f));
    term.hasColor = true;
    term.hasAlpha = false; // an RGB texture
    CHECK(applied(TextureEnvironment::Replace) == Vec4(Vec3(texture), 0.5f));
    CHECK(applied(TextureEnvironment::Modulate) == Vec4(Vec3(lit * texture), 0.5f));
}
