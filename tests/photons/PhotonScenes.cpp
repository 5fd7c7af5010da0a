// PhotonScenes.cpp - scenes that are hard for photons, in each of which path tracing converges.
// SPDX-License-Identifier: MIT
#include "tests/photons/PhotonScenes.h"

#include "tests/Statistics.h"

#include <cmath>

namespace osgRayTrace::engine::test
{

namespace
{

/// Returns a floor, a back wall and a side wall; the lamps are so large that paths find them by
/// chance after a mirror or glass.
SceneBuilder room(bool lit = true)
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.6f)));
    builder.add(quadMesh({-2, 1.5f, 0}, {4, 0, 0}, {0, 0, 3}), lambert(Vec3(0.3f, 0.5f, 0.7f)));
    builder.add(quadMesh({-2, -2, 0}, {0, 4, 0}, {0, 0, 3}), lambert(Vec3(0.7f, 0.5f, 0.3f)));
    if (lit) builder.addQuadLight({-1.1f, -1.1f, 2.6f}, {0, 2.2f, 0}, {2.2f, 0, 0}, Vec3(2.0f));
    return builder;
}

std::shared_ptr<Mesh> smoothBall(Vec3 centre, float radius, int rows)
{
    auto ball = sphereMesh(centre, radius, rows);
    std::vector<Vec3> normals;
    for (const Vec3& p : ball->positions)
        normals.push_back(glm::normalize(p - centre));
    ball->normals = std::move(normals);
    return ball;
}

void place(SceneBuilder& builder, uint32_t instance, const Mat3& linear, Vec3 translation)
{
    Instance& placed = builder.scene->instances[instance];
    placed.placed = true;
    placed.engineFromLocal.linear = linear;
    placed.engineFromLocal.translation = translation;
    placed.mirrored = glm::determinant(linear) < 0.0f;
}

Material clear(float transmission, float metallic, float roughness)
{
    Material material = glass(1.5f, roughness);
    material.baseColor = Vec3(0.9f, 0.7f, 0.8f);
    material.transmission = transmission;
    material.metallic = metallic;
    return material;
}

/// Returns coarse balls whose interpolated normals are up to ten degrees off their facets.
SceneBuilder smoothBalls(const Material& material)
{
    SceneBuilder builder = room();
    builder.add(smoothBall({-0.6f, 0, 0.6f}, 0.5f, 9), material);
    builder.add(smoothBall({0.7f, -0.3f, 0.5f}, 0.45f, 12), material);
    return builder;
}

/// Returns a smooth ball and a smooth-shaded box, both of them mirrored, stretched and turned.
SceneBuilder placedSmooth(const Material& material)
{
    SceneBuilder builder = room();
    const auto ball = smoothBall(Vec3(0.0f), 0.4f, 24);
    const uint32_t first = builder.add(ball, material);
    builder.scene->instances.push_back(builder.scene->instances[first]);
    const Mat3 turned(0.8f, 0.6f, 0, -0.6f, 0.8f, 0, 0, 0, 1);
    place(builder, first, turned * Mat3(-1.6f, 0, 0, 0, 0.7f, 0, 0, 0, 1), {-0.6f, 0.1f, 0.55f});
    place(builder, first + 1, Mat3(0.6f, 0, 0.2f, 0, 1.2f, 0, 0, 0.1f, 1.3f), {0.7f, -0.2f, 0.7f});
    return builder;
}

SceneBuilder translucent()
{
    SceneBuilder builder = room();
    builder.add(sphereMesh({-0.6f, 0, 0.6f}, 0.45f, 24), clear(0.5f, 0.3f, 0.0f));
    builder.add(boxMesh({0.2f, -0.5f, 0.1f}, {1.0f, -0.3f, 1.0f}), clear(0.6f, 0.0f, 0.0f));
    builder.add(quadMesh({-0.5f, -1, 1.4f}, {1.2f, 0, 0}, {0, 1, 0.1f}), clear(0.7f, 0.0f, 0.0f));
    return builder;
}

/// Returns panes without an interface, which let a part of the light straight through, as the
/// checks of a texture decide.
SceneBuilder panes()
{
    SceneBuilder builder = room();
    auto checks = std::make_shared<Texture>();
    checks->width = checks->height = 8;
    for (int i = 0; i < 64; ++i)
    {
        const float share = (i % 8 / 2 + i / 16) % 2 ? 0.9f : 0.0f;
        for (const float c : {share, 0.5f, 0.5f, 1.0f})
            checks->floats.push_back(c);
    }
    builder.scene->textures = {checks};
    Material pane = clear(1.0f, 0.0f, 0.0f);
    pane.ior = 1.0f;
    pane.transmissionTexture = 0;
    for (const float x : {-1.0f, 0.2f})
    {
        auto mesh = quadMesh({x, -0.8f, 1.0f}, {0.9f, 0, 0}, {0, 1.2f, 0.4f});
        mesh->uvs = std::vector<Vec2>{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
        builder.add(mesh, pane);
    }
    builder.add(sphereMesh({0.1f, 0.3f, 0.5f}, 0.4f, 24), glass(1.5f));
    return builder;
}

SceneBuilder manyLights()
{
    SceneBuilder builder = room(false);
    builder.add(boxMesh({-0.3f, -0.3f, 0}, {0.3f, 0.3f, 0.8f}), lambert(Vec3(0.4f, 0.6f, 0.4f)));
    Uniform uniform(3);
    for (int k = 0; k < 40; ++k)
    {
        const Vec3 at(3.4f * uniform() - 1.7f, 3.0f * uniform() - 1.7f, 1.2f + 1.6f * uniform());
        const float power = std::exp(4.0f * uniform() - 3.0f);
        if (k % 4 == 0)
            builder.addEmissive(sphereMesh(at, 0.1f, 6), lamp(Vec3(power, 0.5f * power, power)));
        else if (k % 4 == 1)
            builder.addQuadLight(at, {0, 0.2f, 0}, {0.2f, 0, 0.1f}, Vec3(power), k % 8 == 1);
        else if (k % 4 == 2)
            builder.addLight(pointLight(at, Vec3(0.02f * power)));
        else
        {
            Light spot = pointLight(at, Vec3(0.1f * power));
            spot.direction = glm::normalize(Vec3(uniform() - 0.5f, uniform() - 0.5f, -1.0f));
            spot.spotCosCutoff = 0.7f;
            spot.spotExponent = k % 8 == 3 ? 0.0f : 8.0f;
            builder.addLight(spot);
        }
    }
    return builder;
}

/// Returns a room with a sun, a spot, and an OpenGL light that fades slowly and does not light the
/// box.
SceneBuilder sunAndSpot()
{
    SceneBuilder builder = room(false);
    Light sun;
    sun.kind = LightKind::Directional;
    sun.diffuse = Vec3(0.8f, 0.7f, 0.5f);
    sun.direction = glm::normalize(Vec3(-0.5f, 0.6f, -1.0f));
    sun.number = 0;
    builder.addLight(sun);
    Light spot = pointLight({0.8f, -0.8f, 2.2f}, Vec3(2.0f, 1.0f, 1.0f));
    spot.direction = glm::normalize(Vec3(-0.4f, 0.4f, -1.0f));
    spot.spotCosCutoff = std::cos(0.5f);
    spot.spotExponent = 3.0f;
    spot.number = 1;
    builder.addLight(spot);
    Light slow = pointLight({0.0f, -1.0f, 1.5f}, Vec3(0.2f, 0.2f, 0.4f));
    slow.attenuationConstant = 0.5f;
    slow.attenuationLinear = 0.3f;
    slow.attenuationQuadratic = 0.1f;
    slow.number = 2;
    builder.addLight(slow);
    Material blind = lambert(Vec3(0.5f));
    blind.lightMask = ~4u;
    builder.add(boxMesh({-0.9f, -0.3f, 0}, {-0.3f, 0.3f, 0.9f}), blind);
    builder.add(smoothBall({0.6f, 0, 0.5f}, 0.45f, 24), lambert(Vec3(0.7f, 0.4f, 0.4f)));
    return builder;
}

/// Returns a room with a sun that casts shadows and a sun that nothing hides. The latter lights the
/// floor below a table, the walls behind each other, and the inside of a box.
SceneBuilder lightWithoutShadows()
{
    SceneBuilder builder = room(false);
    Light sun;
    sun.kind = LightKind::Directional;
    sun.diffuse = Vec3(0.3f, 0.4f, 0.5f);
    sun.direction = glm::normalize(Vec3(-0.4f, 0.8f, -1.0f));
    builder.addLight(sun);
    sun.number = 1;
    sun.diffuse = Vec3(0.8f, 0.7f, 0.5f);
    sun.direction = glm::normalize(Vec3(-0.2f, 0.5f, -1.0f));
    sun.castsShadows = false;
    builder.addLight(sun);
    builder.add(boxMesh({-1.2f, -0.6f, 0.9f}, {0.2f, 0.6f, 1.0f}), lambert(Vec3(0.6f)));
    builder.add(boxMesh({0.5f, -0.4f, 0}, {1.3f, 0.4f, 1.2f}), lambert(Vec3(0.7f, 0.4f, 0.4f)));
    builder.add(smoothBall({0.9f, 0, 0.4f}, 0.3f, 24), lambert(Vec3(0.5f)));
    return builder;
}

/// Returns lamps within glass: no shadow ray reaches them from outside.
SceneBuilder lampsInGlass()
{
    SceneBuilder builder = room(false);
    builder.add(sphereMesh({-0.5f, 0, 1.0f}, 0.6f, 24), glass(1.5f));
    builder.addEmissive(sphereMesh({-0.5f, 0, 1.0f}, 0.4f, 12), lamp(Vec3(3, 2, 1)));
    builder.add(boxMesh({0.3f, -0.6f, 0.4f}, {1.3f, 0.2f, 1.2f}), glass(1.3f));
    builder.addQuadLight({0.4f, -0.5f, 0.9f}, {0, 0.6f, 0}, {0.8f, 0, 0}, Vec3(2, 3, 4));
    return builder;
}

/// Returns bodies of OpenGL's materials with highlights from broad to narrow.
SceneBuilder highlights()
{
    SceneBuilder builder = room();
    const float shininess[] = {2.0f, 20.0f, 128.0f};
    for (int k = 0; k < 3; ++k)
    {
        Material material;
        material.diffuse = Vec3(0.5f, 0.3f, 0.2f);
        material.specular = Vec3(0.4f);
        material.shininess = shininess[k];
        builder.add(sphereMesh({-1.0f + float(k), -0.1f, 0.5f}, 0.42f, 24), material);
    }
    return builder;
}

/// Returns polished metal and a mirror. The widths of the glossy lobes are below and above the one
/// at which photons end paths.
SceneBuilder polishedMetal()
{
    SceneBuilder builder = room();
    int k = 0;
    for (const float roughness : {0.3f, 0.45f, 0.55f})
    {
        Material material = mirror(Vec3(0.9f, 0.8f, 0.6f));
        material.roughness = roughness;
        builder.add(sphereMesh({-1.0f + float(k++), -0.1f, 0.5f}, 0.42f, 24), material);
    }
    builder.add(quadMesh({1.9f, 1.5f, 0}, {0, -3, 0}, {0, 0, 2}), mirror(Vec3(0.9f)));
    return builder;
}

/// Returns a scene in which all faces exist from one side only. It is a room that is looked into
/// through its near wall, with shades that hold back the light from above, or let it pass and are
/// lit. Clear and dull bodies are without their far halves.
SceneBuilder oneSided()
{
    SceneBuilder builder = room(false);
    builder.add(quadMesh({-2, -2, 0}, {0, 0, 3}, {4, 0, 0}), lambert(Vec3(0.8f, 0.3f, 0.3f)));
    builder.add(quadMesh({-1.5f, -0.9f, 1.5f}, {0, 0.8f, 0}, {0.9f, 0, 0}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({0.5f, -0.9f, 1.4f}, {0.9f, 0, 0}, {0, 0.8f, 0}),
                lambert(Vec3(0.3f, 0.7f, 0.3f)));
    builder.add(sphereMesh({-0.6f, 0.1f, 0.6f}, 0.5f, 24), glass(1.5f));
    builder.add(boxMesh({0.3f, -0.1f, 0}, {0.9f, 0.5f, 0.9f}), lambert(Vec3(0.6f)));
    builder.add(quadMesh({1.9f, 1.4f, 0.2f}, {0, 0, 1.5f}, {0, -2, 0}), mirror(Vec3(0.9f)));
    for (Material& material : builder.scene->materials)
    {
        material.culling = FaceCulling::Back;
        material.cullsAllRays = true;
    }
    builder.addQuadLight({-1.1f, -1.1f, 2.6f}, {0, 2.2f, 0}, {2.2f, 0, 0}, Vec3(2.0f));
    return builder;
}

SceneBuilder tallMirrorBox()
{
    SceneBuilder builder = cornellBox();
    Scene& scene = *builder.scene;
    // The five sides of the tall block follow the room's five and the short block's five.
    for (std::size_t i = 10; i < 15; ++i)
    {
        scene.materials.push_back(mirror(Vec3(0.95f)));
        scene.instances[i].material = static_cast<uint32_t>(scene.materials.size() - 1);
    }
    return builder;
}

} // namespace

std::vector<ComparedScene> photonScenes(int width, int height)
{
    const View inRoom = perspectiveView({0.4, -4, 2}, {0, 0, 0.7}, {0, 0, 1}, 42.0, width, height);
    Material coated = lambert(Vec3(0.6f, 0.5f, 0.4f));
    coated.ior = 1.5f;
    coated.roughness = 0.0f;
    return {{"tall mirror box", tallMirrorBox().build(), cornellView(width, height), true, 550.0},
            {"smooth diffuse balls", smoothBalls(lambert(Vec3(0.8f))).build(), inRoom},
            {"smooth mirror balls", smoothBalls(mirror(Vec3(0.9f))).build(), inRoom, true},
            {"smooth glass balls", smoothBalls(glass(1.5f)).build(), inRoom, true},
            {"smooth coated balls", smoothBalls(coated).build(), inRoom, true},
            {"placed glass", placedSmooth(glass(1.5f)).build(), inRoom, true},
            {"placed diffuse", placedSmooth(lambert(Vec3(0.8f))).build(), inRoom},
            {"translucent", translucent().build(), inRoom, true},
            {"panes", panes().build(), inRoom, true},
            {"many lights", manyLights().build(), inRoom},
            {"sun and spot", sunAndSpot().build(), inRoom},
            {"light without shadows", lightWithoutShadows().build(), inRoom},
            {"lamps in glass", lampsInGlass().build(), inRoom, true},
            {"highlights", highlights().build(), inRoom},
            {"one-sided", oneSided().build(), inRoom, true},
            {"polished metal", polishedMetal().build(), inRoom, true}};
}

} // namespace osgRayTrace::engine::test
