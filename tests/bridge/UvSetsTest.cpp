// UvSetsTest.cpp - texture coordinates of units above 1, for textures of physical materials.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/bridge/TexturedGraphs.h"

#include "osgRayTrace/bridge/geometry/GeometryConverter.h"

#include <osgRayTrace/PhysicalMaterial>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

/// Returns the coordinates (unit, i), which differ in each unit and vertex.
osg::ref_ptr<osg::Vec2Array> coordinatesOf(int unit)
{
    const osg::ref_ptr<osg::Vec2Array> array = new osg::Vec2Array;
    for (int i = 0; i < 3; ++i)
        array->push_back(osg::Vec2(float(unit), float(i)));
    array->reserve(8);
    return array;
}

osg::ref_ptr<osg::Geometry> geometryOf(int units)
{
    const auto geometry = triangleGeometry();
    for (int unit = 0; unit < units; ++unit)
        geometry->setTexCoordArray(unsigned(unit), coordinatesOf(unit));
    return geometry;
}

osg::ref_ptr<PhysicalMaterial> materialOf(std::initializer_list<unsigned int> units)
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    int use = PhysicalMaterial::BASE_COLOR_TEXTURE;
    for (const unsigned int unit : units)
    {
        PhysicalMaterial::TexturePlace place;
        place.unit = unit;
        material->setTexturePlace(static_cast<PhysicalMaterial::TextureUse>(use), place);
        material->setTexture(static_cast<PhysicalMaterial::TextureUse>(use++), smallTexture());
    }
    return material;
}

/// Returns the sets that a mesh has beyond the first two.
std::vector<uint32_t> moreSetsOf(const Mesh& mesh)
{
    std::vector<uint32_t> sets;
    for (uint32_t set = kFirstMoreUvs; set < kUvSets; ++set)
        if (!uvsOfSet(mesh, set).empty()) sets.push_back(set);
    return sets;
}

using Sets = std::vector<uint32_t>;

} // namespace

TEST_CASE("uv sets: a mesh has those that its materials read, and shares their arrays", "[bridge]")
{
    const auto geometry = geometryOf(8);
    CHECK(soleMesh(convertGraph(geometry)).moreUvs.empty());
    geometry->getOrCreateStateSet()->setAttribute(materialOf({0, 1}));
    CHECK(soleMesh(convertGraph(geometry)).moreUvs.empty());

    geometry->getStateSet()->setAttribute(materialOf({0, 3, 7}));
    const ConversionResult result = convertGraph(geometry);
    const Mesh& mesh = soleMesh(result);
    CHECK(moreSetsOf(mesh) == Sets{3, 7});
    CHECK(static_cast<const void*>(uvsOfSet(mesh, 7).data()) ==
          geometry->getTexCoordArray(7)->getDataPointer());
    CHECK(uvsOfSet(mesh, 3)[2] == Vec2(3.0f, 2.0f));
    const MaterialDetail& detail = *soleMaterial(result).detail;
    CHECK(detail.places[kMetallicRoughnessRole].set == 3);
    CHECK(countOf(result, "approximated.no-texture-coordinates") == 0);

    geometry->setTexCoordArray(7, nullptr);
    const ConversionResult without = convertGraph(geometry);
    CHECK(moreSetsOf(soleMesh(without)) == Sets{3});
    CHECK(countOf(without, "approximated.no-texture-coordinates") == 1);
    CHECK(soleMaterial(without).transmissionTexture == kInvalid);

    // Anisotropy has the axes of its place, without a texture.
    const auto brushed = materialOf({});
    PhysicalMaterial::TexturePlace place;
    place.unit = 5;
    brushed->setTexturePlace(PhysicalMaterial::ANISOTROPY_TEXTURE, place);
    brushed->setAnisotropy(0.5f);
    geometry->getStateSet()->setAttribute(brushed);
    CHECK(moreSetsOf(soleMesh(convertGraph(geometry))) == Sets{5});
}

TEST_CASE("uv sets: uses with other materials share a mesh that has the sets of all", "[bridge]")
{
    const auto geometry = geometryOf(6);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (const unsigned int unit : {2u, 4u})
    {
        const auto use = placed(osg::Matrixd::translate(unit, 0, 0), geometry);
        use->getOrCreateStateSet()->setAttribute(materialOf({unit}));
        root->addChild(use);
    }
    SceneConverter converter;
    const ConversionResult result = converter.convert(inputFor(root));
    REQUIRE(result.scene->instances.size() == 2);
    CHECK(result.scene->instances[0].mesh == result.scene->instances[1].mesh);
    CHECK(moreSetsOf(soleMesh(result)) == Sets{2, 4});

    // Another array, another set, another use: the next scene has them.
    auto& uvs = static_cast<osg::Vec2Array&>(*geometry->getTexCoordArray(4));
    uvs[1].set(0.25f, 0.5f);
    uvs.dirty();
    CHECK(uvsOfSet(soleMesh(converter.convert(inputFor(root))), 4)[1] == Vec2(0.25f, 0.5f));
    root->getChild(0)->getStateSet()->setAttribute(materialOf({3}));
    CHECK(moreSetsOf(soleMesh(converter.convert(inputFor(root)))) == Sets{3, 4});
    const auto more = placed(osg::Matrixd::translate(9, 0, 0), geometry);
    more->getOrCreateStateSet()->setAttribute(materialOf({5}));
    root->addChild(more);
    CHECK(moreSetsOf(soleMesh(converter.convert(inputFor(root)))) == Sets{3, 4, 5});
}

TEST_CASE("uv sets: clip planes, solids and deforming keep them", "[bridge]")
{
    const auto geometry = geometryOf(4);
    MeshRequest request;
    request.uvSets = 1u << 3;
    request.clipPlanes = {Vec4d(-1.0, 0.0, 0.0, 0.5)}; // x below a half
    const Mesh cut = *convertGeometry(*geometry, request).mesh;
    const SharedArray<Vec2>& uvs = uvsOfSet(cut, 3);
    REQUIRE(uvs.size() == cut.positions.size());
    for (const UVec3& t : cut.triangles)
        for (int corner = 0; corner < 3; ++corner)
        {
            const Vec3 p = cut.positions[t[corner]];
            CHECK(glm::length(uvs[t[corner]] - Vec2(3.0f, p.x + 2.0f * p.y)) < 1e-5f);
        }

    request.clipPlanes.clear();
    request.pointRadius = 0.1f;
    const GLuint ends[] = {1, 2};
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(GL_LINES, 2, ends));
    const Mesh solids = *convertGeometry(*geometry, request).mesh;
    REQUIRE(uvsOfSet(solids, 3).size() == solids.positions.size());
    CHECK(uvsOfSet(solids, 3)[uint32_t(solids.positions.size() - 1)].x == 3.0f);

    request.pointRadius = 0.0f;
    request.copies = true;
    KeptArrays kept;
    kept.moreUvs = {{}, std::vector<Vec2>(3, Vec2(9.0f))};
    const Mesh deformed = *convertGeometry(*geometry, request, kept).mesh;
    CHECK(uvsOfSet(deformed, 3).data() == kept.moreUvs[1].data());
}
