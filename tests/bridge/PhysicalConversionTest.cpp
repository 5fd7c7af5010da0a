// PhysicalConversionTest.cpp - what becomes of the parameters of a PhysicalMaterial. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/bridge/TexturedGraphs.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"
#include "osgRayTrace/bridge/geometry/GeometryConverter.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osgRayTrace/PhysicalMaterial>

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

Material materialOf(const osg::ref_ptr<osg::Geometry>& geometry, PhysicalMaterial* physical)
{
    geometry->getOrCreateStateSet()->setAttribute(physical);
    return soleMaterial(convertGraph(geometry));
}

} // namespace

TEST_CASE("physical material: details are there only where some parameter needs them", "[bridge]")
{
    const osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    physical->setAttenuationColor(osg::Vec3(0.1f, 0.2f, 0.3f)); // nothing without a distance
    physical->setSheenRoughness(0.5f);
    const Material plain = materialOf(triangleGeometry(), physical);
    CHECK_FALSE(plain.detail);

    physical->setAttenuationDistance(2.0f);
    physical->setSpecular(0.25f);
    physical->setSpecularColor(osg::Vec3(2.0f, 1.0f, 0.5f));
    physical->setClearcoat(0.75f);
    physical->setClearcoatRoughness(0.125f);
    physical->setClearcoatNormalScale(-2.0f);
    physical->setSheenColor(osg::Vec3(0.5f, 0.25f, 0.0f));
    const Material full = materialOf(triangleGeometry(), physical);
    REQUIRE(full.detail);
    for (int c = 0; c < 3; ++c)
        CHECK(full.detail->interior.sigmaA[c] == Approx(-std::log(0.1 * (c + 1)) / 2.0));
    CHECK(full.detail->specular == 0.25f);
    CHECK(full.detail->specularColor == Vec3(2.0f, 1.0f, 0.5f));
    CHECK(full.detail->clearcoat == 0.75f);
    CHECK(full.detail->clearcoatRoughness == 0.125f);
    CHECK(full.detail->clearcoatNormalScale == -2.0f);
    CHECK(full.detail->sheenColor == Vec3(0.5f, 0.25f, 0.0f));
    CHECK(full.detail->sheenRoughness == 0.5f);
    CHECK(full.detail->absorbs());
    CHECK_FALSE(sameMaterial(plain, full));
    physical->setThinWalled(true);
    const Material thin = materialOf(triangleGeometry(), physical);
    CHECK(thin.detail->thinWalled);
    CHECK_FALSE(thin.detail->absorbs());
    CHECK_FALSE(sameMaterial(thin, full));
}

TEST_CASE("physical material: anisotropy, diffuse transmission and films", "[bridge]")
{
    const osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    physical->setAnisotropyRotation(2.0f); // nothing without the strengths
    physical->setDiffuseTransmissionColor(osg::Vec3(0.1f, 0.2f, 0.3f));
    physical->setIridescenceIor(1.6f);
    physical->setIridescenceThicknessMinimum(150.0f);
    physical->setIridescenceThicknessMaximum(650.0f);
    CHECK_FALSE(materialOf(triangleGeometry(), physical).detail);

    physical->setAnisotropy(0.25f);
    const auto bare = triangleGeometry(), mapped = triangleGeometry(), brushed = triangleGeometry();
    mapped->setTexCoordArray(0, new osg::Vec2Array(3));
    brushed->setVertexAttribArray(6, new osg::Vec4Array(3), osg::Array::BIND_PER_VERTEX);
    CHECK(materialOf(bare, physical).detail->anisotropy == 0.0f); // there is no direction
    CHECK(countOf(convertGraph(bare), "approximated.no-texture-coordinates") == 1);
    CHECK(materialOf(mapped, physical).detail->anisotropy == 0.25f);
    CHECK(materialOf(mapped, physical).detail->anisotropyRotation == 2.0f);
    CHECK(materialOf(brushed, physical).detail->anisotropy == 0.25f);
    CHECK(countOf(convertGraph(mapped), "approximated.no-texture-coordinates") == 0);

    physical->setAnisotropy(0.0f);
    physical->setDiffuseTransmission(0.5f);
    const Material leaf = materialOf(triangleGeometry(), physical);
    REQUIRE(leaf.detail);
    CHECK(leaf.detail->diffuseTransmission == 0.5f);
    CHECK(leaf.detail->diffuseTransmissionColor == Vec3(0.1f, 0.2f, 0.3f));
    physical->setDiffuseTransmission(0.0f);
    physical->setSubsurface(0.5f);
    physical->setSubsurfaceRadius(osg::Vec3(1.0f, 0.2f, 0.1f));
    const Material skin = materialOf(triangleGeometry(), physical);
    REQUIRE(skin.detail);
    CHECK(skin.detail->subsurface == 0.5f);
    CHECK(skin.detail->subsurfaceRadius == Vec3(1.0f, 0.2f, 0.1f));
    CHECK(hasSubsurface(skin));
    physical->setSubsurfaceRadius(osg::Vec3(1.0f, 0.3f, 0.1f));
    CHECK_FALSE(sameMaterial(skin, materialOf(triangleGeometry(), physical)));
    physical->setSubsurface(0.0f);
    physical->setIridescence(0.75f);
    const Material film = materialOf(triangleGeometry(), physical);
    REQUIRE(film.detail);
    CHECK(film.detail->iridescence == 0.75f);
    CHECK(film.detail->iridescenceIor == 1.6f);
    CHECK(film.detail->iridescenceThickness == Vec2(150.0f, 650.0f));
    CHECK_FALSE(sameMaterial(leaf, film));
    physical->setIridescenceThicknessMinimum(151.0f);
    CHECK_FALSE(sameMaterial(materialOf(triangleGeometry(), physical), film));
}

TEST_CASE("physical material: vertex colours count if the material asks for them", "[bridge]")
{
    const osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    physical->setBaseColor(osg::Vec3(0.5f, 0.5f, 1.0f));
    const auto geometry = triangleGeometry();
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(1);
    (*colors)[0].set(0.5f, 1.0f, 0.0f, 0.25f);
    geometry->setColorArray(colors, osg::Array::BIND_OVERALL);
    CHECK(materialOf(geometry, physical).baseColor == Vec3(0.5f, 0.5f, 1.0f));
    physical->setVertexColors(true);
    const Material overall = materialOf(geometry, physical);
    CHECK(overall.baseColor.x == Approx(0.5f * linearFromSrgb(0.5f)));
    CHECK(overall.baseColor.y == 0.5f);
    CHECK(overall.baseColor.z == 0.0f);
    CHECK_FALSE(overall.detail->vertexColors);

    geometry->setColorArray(new osg::Vec4Array(3), osg::Array::BIND_PER_VERTEX);
    const Material varying = materialOf(geometry, physical);
    CHECK(varying.baseColor == Vec3(0.5f, 0.5f, 1.0f));
    CHECK(varying.detail->vertexColors);
}

TEST_CASE("physical material: textures have their place, and are left out without coordinates",
          "[bridge]")
{
    const osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    const auto texture = smallTexture();
    for (const auto use :
         {PhysicalMaterial::NORMAL_TEXTURE, PhysicalMaterial::SPECULAR_TEXTURE,
          PhysicalMaterial::SHEEN_COLOR_TEXTURE, PhysicalMaterial::SUBSURFACE_TEXTURE,
          PhysicalMaterial::SUBSURFACE_RADIUS_TEXTURE})
        physical->setTexture(use, texture);
    PhysicalMaterial::TexturePlace place;
    place.offset.set(0.25f, 0.5f);
    place.rotation = static_cast<float>(M_PI / 2.0);
    place.scale.set(2.0f, 3.0f);
    physical->setTexturePlace(PhysicalMaterial::SPECULAR_TEXTURE, place);
    place.unit = 1;
    physical->setTexturePlace(PhysicalMaterial::SHEEN_COLOR_TEXTURE, place);
    const auto geometry = triangleGeometry();
    geometry->setTexCoordArray(0, new osg::Vec2Array(3));
    geometry->getOrCreateStateSet()->setAttribute(physical);

    const ConversionResult result = convertGraph(geometry);
    const Material& material = soleMaterial(result);
    REQUIRE(material.detail);
    CHECK(hasNormalMap(material));
    CHECK_FALSE(hasCoatNormals(material));
    physical->setClearcoat(1.0f);
    const ConversionResult coated = convertGraph(geometry);
    CHECK(hasCoatNormals(soleMaterial(coated)));
    CHECK(countOf(coated, "approximated.coat-normal") == 0);
    physical->setThinWalled(true); // a wall passes light straight by one normal alone
    physical->setTransmission(0.5f);
    CHECK(countOf(convertGraph(geometry), "approximated.coat-normal") == 1);
    physical->setThinWalled(false);
    physical->setTransmission(0.0f);
    physical->setClearcoat(0.0f);
    CHECK_FALSE(result.scene->textures.at(material.detail->textures[kNormalRole])->decodeSrgb);
    for (const TextureRole role : {kSubsurfaceRole, kSubsurfaceRadiusRole}) // lengths, not colours
        CHECK_FALSE(result.scene->textures.at(material.detail->textures[role])->decodeSrgb);
    CHECK(material.detail->textures[kSheenColorRole] == kInvalid);
    CHECK(countOf(result, "approximated.no-texture-coordinates") == 1);
    const TexturePlace& placed = material.detail->places[kSpecularRole];
    CHECK(glm::length(placed.u - Vec2(0.0f, 2.0f)) < 1e-6f); // a quarter turn from s to t
    CHECK(glm::length(placed.v - Vec2(-3.0f, 0.0f)) < 1e-6f);
    CHECK(placed.offset == Vec2(0.25f, 0.5f));

    geometry->setTexCoordArray(1, new osg::Vec2Array(3));
    const ConversionResult both = convertGraph(geometry);
    const MaterialDetail& detail = *soleMaterial(both).detail;
    CHECK(detail.places[kSheenColorRole].set == 1);
    CHECK(both.scene->textures.at(detail.textures[kSheenColorRole])->decodeSrgb);
}

TEST_CASE("tangents: vertex attribute 6 is read with its signs, also through transforms",
          "[bridge]")
{
    const auto geometry = triangleGeometry();
    const osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array;
    for (const osg::Vec4& tangent :
         {osg::Vec4(1, 0, 0, 1), osg::Vec4(1, 0, 0, -1), osg::Vec4(0, 1, 0, 1)})
        tangents->push_back(tangent);
    geometry->setVertexAttribArray(6, tangents, osg::Array::BIND_PER_VERTEX);
    CHECK(soleMesh(convertGraph(geometry)).tangents[1] == Vec4(1, 0, 0, -1));
    MeshRequest request;
    request.transform = osg::Matrixd::scale(-2.0, 1.0, 1.0);
    const Mesh mirrored = *convertGeometry(*geometry, request).mesh;
    REQUIRE(mirrored.tangents.size() == 3);
    CHECK(mirrored.tangents[0] == Vec4(-2, 0, 0, -1));
    CHECK(mirrored.tangents[1] == Vec4(-2, 0, 0, 1));
    CHECK(mirrored.tangents[2] == Vec4(0, 1, 0, -1));
    request.copies = true; // it will deform, and its tangents will not
    CHECK(convertGeometry(*geometry, request).mesh->tangents.empty());
    geometry->setVertexAttribArray(6, new osg::Vec3Array(3), osg::Array::BIND_PER_VERTEX);
    CHECK(soleMesh(convertGraph(geometry)).tangents.empty()); // somebody else's attribute
}
