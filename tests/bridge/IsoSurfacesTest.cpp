// IsoSurfacesTest.cpp - isosurfaces of osgVolume's tiles become closed meshes. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/IsoSurface.h"
#include "osgRayTrace/media/VolumeSample.h"
#include "osgRayTrace/sampling/Sampler.h"

#include "tests/Catch.h"
#include "tests/EnclosedVolume.h"
#include "tests/VolumeTiles.h"
#include "tests/api/Picks.h"
#include "tests/bridge/Graphs.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/PhysicalMaterial>

#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;
using engine::test::enclosedVolume;

namespace
{

constexpr std::size_t kMany = 10'000'000;

/// Returns how many edges lack a triangle at one of their sides.
std::size_t openEdges(const std::vector<UVec3>& triangles)
{
    std::map<std::pair<uint32_t, uint32_t>, int> sides;
    for (const UVec3& t : triangles)
        for (int k = 0; k < 3; ++k)
        {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    return static_cast<std::size_t>(
        std::count_if(sides.begin(), sides.end(), [](const auto& side) { return side.second; }));
}

/// Returns an image of one channel whose values are a function of the middles of its voxels.
template <class Value> VolumeImage imageOf(int width, int height, int depth, const Value& value)
{
    VolumeImage image;
    image.width = width;
    image.height = height;
    image.depth = depth;
    for (int z = 0; z < depth; ++z)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                image.floats.push_back(
                    value(Vec3((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height),
                               (float(z) + 0.5f) / float(depth))));
    return image;
}

VolumeImage softBall(int width, int height, int depth)
{
    return imageOf(width, height, depth,
                   [](Vec3 p) { return 1.0f - 2.0f * glm::length(p - Vec3(0.5f)); });
}

osg::ref_ptr<osgVolume::VolumeTile> isoTile(osg::Image* image, osg::TransferFunction1D* transfer)
{
    const auto tile = tileOf(image, transfer, new osgVolume::MultipassTechnique,
                             osg::Matrixd::scale(2.0, 3.0, 4.0));
    addProperty(*tile, new osgVolume::IsoSurfaceProperty(0.5f));
    return tile;
}

osgVolume::IsoSurfaceProperty& isoOf(osgVolume::VolumeTile& tile)
{
    auto* all = static_cast<osgVolume::CompositeProperty*>(tile.getLayer()->getProperty());
    for (unsigned int i = 0; i < all->getNumProperties(); ++i)
        if (auto* iso = dynamic_cast<osgVolume::IsoSurfaceProperty*>(all->getProperty(i)))
            return *iso;
    throw std::runtime_error("no isosurface");
}

osg::ref_ptr<osg::Group> groupWith(osg::Node* tile)
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    root->addChild(tile);
    return root;
}

/// Returns the box of an instance's triangles in engine space.
std::pair<Vec3, Vec3> boxOf(const Scene& scene, const Instance& instance)
{
    const Mesh& mesh = *scene.meshes[instance.mesh];
    Vec3 low(kInfinity), high(-kInfinity);
    for (const UVec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
        {
            Vec3 p = mesh.positions[t[k]];
            if (instance.placed) p = transformPoint(instance.engineFromLocal, p);
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    return {low, high};
}

/// Returns the instance with the most triangles: the isosurface beside the triangle.
const Instance& surfaceIn(const Scene& scene)
{
    return *std::max_element(scene.instances.begin(), scene.instances.end(),
                             [&](const Instance& a, const Instance& b) {
                                 return scene.meshes[a.mesh]->triangles.size() <
                                        scene.meshes[b.mesh]->triangles.size();
                             });
}

} // namespace

TEST_CASE("isosurfaces: cells have closed borders", "[bridge][volumes]")
{
    for (unsigned int inside = 0; inside < 256; ++inside)
    {
        const IsoCell& cell = isoCell(inside);
        std::set<int> crossed, met;
        for (unsigned int a = 0; a < 8; ++a)
            for (int axis = 0; axis < 3; ++axis)
            {
                const unsigned int b = a | 1u << axis;
                if (a == b || (inside >> a & 1u) == (inside >> b & 1u)) continue;
                const int edges[] = {int(a >> 1), int(4 + (a & 1) + (a >> 2) * 2), int(8 + a)};
                crossed.insert(edges[axis]);
            }
        REQUIRE(cell.triangles <= 10);
        // Sides that two triangles of the cell do not share lie in faces of the cell.
        std::map<std::pair<int, int>, int> sides;
        for (int i = 0; i < 3 * cell.triangles; ++i)
        {
            const int a = cell.edges[std::size_t(i)],
                      b = cell.edges[std::size_t(i % 3 == 2 ? i - 2 : i + 1)];
            met.insert(a);
            sides[{std::min(a, b), std::max(a, b)}] += 1;
        }
        CAPTURE(inside);
        CHECK(met == crossed);
        const auto facesOf = [](int edge)
        {
            std::set<int> faces;
            for (int k = 0, bit = 0; k < 3; ++k)
                if (k != edge / 4) faces.insert(2 * k + (edge >> bit++ & 1));
            return faces;
        };
        for (const auto& [side, count] : sides)
        {
            const std::set<int> a = facesOf(side.first), b = facesOf(side.second);
            const bool inFace =
                std::any_of(a.begin(), a.end(), [&](int face) { return b.count(face) > 0; });
            CHECK(count == (inFace ? 1 : 2));
        }
    }
}

TEST_CASE("isosurfaces: random voxels give closed surfaces", "[bridge][volumes]")
{
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int round = 0; round < 20; ++round)
    {
        const VolumeImage image = imageOf(9, 1 + round % 7, 6, [&](Vec3) { return unit(engine); });
        Affine box;
        if (round % 3 == 0) box = {Mat3(1.3f), Vec3(-0.2f)};
        if (round % 3 == 1) box.linear[0] = Vec3(0.9f, 0.3f, -0.2f);
        const auto surface = isoSurface(image, 0.3f + 0.02f * float(round), box, kMany);
        REQUIRE(surface);
        CHECK(surface->triangles.size() > 30);
        CHECK(openEdges(surface->triangles) == 0);
        CHECK(enclosedVolume(*surface) > 0.0);
        for (const Vec3& p : surface->positions)
        {
            const Vec3 q = transformPoint(box, p);
            for (int k = 0; k < 3; ++k)
            {
                CHECK((p[k] >= 0.0f && p[k] <= 1.0f));
                CHECK((q[k] > -2e-3f && q[k] < 1.002f)); // corners keep a thousandth of a voxel
            }
        }
    }
}

TEST_CASE("isosurfaces: a ball has its place, its volume and its normals", "[bridge][volumes]")
{
    const VolumeImage image = softBall(40, 50, 30);
    const auto surface = isoSurface(image, 0.5f, {}, kMany);
    REQUIRE(surface);
    // Radius 0.25. The trilinear field and flat triangles are within half a percent of it.
    CHECK(enclosedVolume(*surface) == Approx(4.0 / 3.0 * kPi / 64.0).epsilon(0.01));
    CHECK(openEdges(surface->triangles) == 0);
    for (std::size_t i = 0; i < surface->positions.size(); ++i)
    {
        const Vec3 p = surface->positions[i];
        CHECK(volumeValue(image, p) == Approx(0.5).margin(1e-3));
        CHECK(glm::dot(glm::normalize(surface->normals[i]), glm::normalize(p - Vec3(0.5f))) >
              0.995f);
    }
    CHECK_FALSE(isoSurface(image, 0.5f, {}, 100));
    CHECK(isoSurface(image, 2.0f, {}, kMany)->triangles.empty());
    // Values that reach the border are closed there.
    const auto full = isoSurface(imageOf(5, 6, 7, [](Vec3) { return 1.0f; }), 0.01f, {}, kMany);
    CHECK(openEdges(full->triangles) == 0);
    CHECK(enclosedVolume(*full) > 0.93); // edges of the box are cut by half a voxel
    CHECK(enclosedVolume(*full) < 1.0);
    // A tile that shows the half of the image closes the half ball with a flat face.
    const Affine half{Mat3(2.0f, 0, 0, 0, 1, 0, 0, 0, 1), Vec3(0.0f)};
    const auto cut = isoSurface(image, 0.5f, half, kMany);
    CHECK(openEdges(cut->triangles) == 0);
    CHECK(enclosedVolume(*cut) == Approx(2.0 / 3.0 * kPi / 64.0).epsilon(0.02));
}

TEST_CASE("isosurfaces: a tile becomes a mesh in its place and colour", "[bridge][volumes]")
{
    const auto tile = isoTile(ballImage(16), nullptr);
    const auto root = groupWith(placed(osg::Matrixd::translate(10, 0, 0), tile));
    const ConversionResult result = convertGraph(root);
    CHECK(countOf(result, "converted.isosurface") == 1);
    CHECK(result.scene->volumes.empty());
    REQUIRE(result.scene->instances.size() == 2);
    const Instance& instance = surfaceIn(*result.scene);
    const Vec3 origin(result.scene->origin);
    // The value 0.5 is at a radius of 0.225.
    const auto [low, high] = boxOf(*result.scene, instance);
    const Vec3 size(2.0f, 3.0f, 4.0f), middle = Vec3(10.0f, 0.0f, 0.0f) + 0.5f * size - origin;
    for (int k = 0; k < 3; ++k)
    {
        CHECK(low[k] == Approx(middle[k] - 0.225f * size[k]).margin(0.02 * size[k]));
        CHECK(high[k] == Approx(middle[k] + 0.225f * size[k]).margin(0.02 * size[k]));
    }
    CHECK(result.scene->materials[instance.material].diffuse == Vec3(1.0f));
    CHECK(result.scene->materials[instance.material].alpha == 1.0f);

    const auto colored = isoTile(ballImage(16), blueToYellow(0.5f));
    isoOf(*colored).setValue(0.7f);
    const ConversionResult tinted = convertGraph(groupWith(colored));
    const Material& material = tinted.scene->materials[surfaceIn(*tinted.scene).material];
    CHECK(material.diffuse.x == Approx(0.9).margin(0.02));
    CHECK(material.diffuse.z == Approx(0.2).margin(0.02));
    CHECK(material.alpha == Approx(0.5).margin(0.02));

    // A material of the tile's own wins.
    const osg::ref_ptr<osg::Material> own = new osg::Material;
    own->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.1f, 0.6f, 0.2f, 1.0f));
    colored->getOrCreateStateSet()->setAttribute(own);
    const ConversionResult green = convertGraph(groupWith(colored));
    CHECK(green.scene->materials[surfaceIn(*green.scene).material].diffuse ==
          Vec3(0.1f, 0.6f, 0.2f));
    const osg::ref_ptr<PhysicalMaterial> glass = new PhysicalMaterial;
    glass->setTransmission(1.0f);
    colored->getOrCreateStateSet()->setAttribute(glass);
    const ConversionResult clear = convertGraph(groupWith(colored));
    CHECK(clear.scene->materials[surfaceIn(*clear.scene).material].transmission == 1.0f);
}

TEST_CASE("isosurfaces: what has none is skipped by name or empty", "[bridge][volumes]")
{
    const auto none = isoTile(new osg::Image, nullptr);
    CHECK(countOf(convertGraph(groupWith(none)), "skipped.volume") == 1);
    const auto strange = isoTile(ballImage(8), nullptr);
    isoOf(*strange).setValue(std::numeric_limits<float>::quiet_NaN());
    CHECK(countOf(convertGraph(groupWith(strange)), "skipped.volume") == 1);
    isoOf(*strange).setValue(7.0f);
    const ConversionResult above = convertGraph(groupWith(strange));
    CHECK(countOf(above, "converted.isosurface") == 1);
    CHECK(above.scene->instances.size() == 1);

    const osg::ref_ptr<osg::Image> damaged = new osg::Image;
    damaged->allocateImage(3, 3, 3, GL_LUMINANCE, GL_FLOAT);
    auto* values = reinterpret_cast<float*>(damaged->data());
    std::fill(values, values + 27, 1.0f);
    values[13] = std::numeric_limits<float>::quiet_NaN();
    const ConversionResult repaired = convertGraph(groupWith(isoTile(damaged, nullptr)));
    CHECK(countOf(repaired, "repaired.voxel") == 1);
    const Scene& scene = *repaired.scene;
    CHECK(openEdges({scene.meshes[surfaceIn(scene).mesh]->triangles.begin(),
                     scene.meshes[surfaceIn(scene).mesh]->triangles.end()}) == 0);
}

TEST_CASE("isosurfaces: picks find them below their tile", "[bridge][volumes]")
{
    const auto tile = isoTile(ballImage(16), nullptr);
    const osg::ref_ptr<osg::Node> moved = placed(osg::Matrixd::translate(10, 0, 0), tile);
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(moved);
    const Picks picks = picksByRay(*scene, {{11.0, 1.5, 20.0}, {11.0, 1.5, -20.0}});
    REQUIRE(picks.size() == 1);
    const Pick& pick = picks[0];
    // The ball's radius is 0.225 of the tile's depth of 4, around 2.
    CHECK(pick.getWorldIntersectPoint().z() == Approx(2.9).margin(0.03));
    CHECK(pick.getWorldIntersectPoint().x() == Approx(11.0).epsilon(1e-5));
    osg::Vec3 normal = pick.getWorldIntersectNormal();
    normal.normalize();
    CHECK(normal.z() > 0.9f);
    CHECK(std::count(pick.nodePath.begin(), pick.nodePath.end(), tile.get()) == 1);
    CHECK(pick.drawable->getName() == "isosurface");
}

TEST_CASE("isosurfaces: edits are seen, and mesh nothing again without need", "[bridge][volumes]")
{
    const osg::ref_ptr<osg::Image> image = ballImage(12);
    const auto tile = isoTile(image, blueToYellow(1.0f));
    const osg::ref_ptr<osg::Group> root = groupWith(tile);
    LiveView view(root);
    view.update();
    const auto box = [&] { return boxOf(*view.scene(), surfaceIn(*view.scene())); };
    const auto mesh = [&] { return view.scene()->meshes[surfaceIn(*view.scene()).mesh]; };
    const auto color = [&]
    { return view.scene()->materials[surfaceIn(*view.scene()).material].diffuse; };
    const float width = box().second.x - box().first.x;
    CHECK(width == Approx(0.9).epsilon(0.05));

    isoOf(*tile).setValue(0.25f);
    view.update();
    CHECK(box().second.x - box().first.x == Approx(1.35).epsilon(0.05));

    tile->getLocator()->setTransform(osg::Matrixd::scale(4.0, 3.0, 4.0));
    view.update();
    CHECK(box().second.x - box().first.x == Approx(2.7).epsilon(0.05));
    tile->getLocator()->setTransform(osg::Matrixd::scale(2.0, 3.0, 4.0));
    view.update();
    const auto placedMesh = mesh(); // a mesh that has moved once is placed
    tile->getLocator()->setTransform(osg::Matrixd::scale(4.0, 3.0, 4.0));
    view.update();
    CHECK(mesh() == placedMesh);

    const Vec3 before = color();
    auto* property = static_cast<osgVolume::CompositeProperty*>(tile->getLayer()->getProperty());
    static_cast<osgVolume::TransferFunctionProperty*>(property->getProperty(0))
        ->getTransferFunction()
        ->getImage()
        ->data()[0] = 0;
    const osg::ref_ptr<osg::TransferFunction1D> red = new osg::TransferFunction1D;
    red->setColor(0.0f, osg::Vec4(1, 0, 0, 1));
    red->setColor(1.0f, osg::Vec4(1, 0, 0, 1));
    static_cast<osgVolume::TransferFunctionProperty*>(property->getProperty(0))
        ->setTransferFunction(red);
    view.update();
    CHECK(color() != before);
    CHECK(color() == Vec3(1.0f, 0.0f, 0.0f));
    CHECK(mesh() == placedMesh);

    std::fill(image->data(), image->data() + image->getTotalSizeInBytes(), 0);
    image->data(6, 6, 6)[0] = 255;
    image->dirty();
    view.update();
    CHECK(box().second.x - box().first.x < 1.0f);
    CHECK(wrongPixels(view, *root) <= kRoundedPixels);
    tile->setNodeMask(0);
    view.update();
    CHECK(wrongPixels(view, *root) <= kRoundedPixels);
}
