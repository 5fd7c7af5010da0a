// GraphHashTest.cpp - what counts as a change of the scene. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"

#include "tests/Catch.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/Geometry>
#include <osg/LOD>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osg/TexGenNode>
#include <osg/Texture2D>
#include <osg/Viewport>

#include <utility>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

/// An image that gets other data without a sign, as if another image were at the address of a
/// deleted one.
struct ExchangedImage : osg::Image
{
    void exchange(unsigned char*& data) { std::swap(_data, data); }
};

} // namespace

TEST_CASE("graph hash: changes with what is traced, and with nothing else", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    osg::ref_ptr<osg::Geometry> geometry =
        osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1, 0, 0), osg::Vec3(0, 1, 0));
    osg::ref_ptr<osg::LightSource> lightSource = new osg::LightSource;
    osg::ref_ptr<AreaLight> areaLight = new AreaLight;
    osg::ref_ptr<osg::TexGenNode> texGenNode = new osg::TexGenNode;
    root->addChild(texGenNode);
    root->addChild(transform);
    root->addChild(lightSource);
    root->addChild(areaLight);
    transform->addChild(choice);
    transform->addChild(levels);
    choice->addChild(geometry);
    levels->addChild(new osg::Group, 0.0f, 10.0f);
    levels->addChild(new osg::Group, 10.0f, 1000.0f);
    levels->setCenter(osg::Vec3());
    osg::StateSet* stateSet = root->getOrCreateStateSet();
    osg::ref_ptr<osg::Material> material = new osg::Material;
    osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    osg::ref_ptr<ExchangedImage> image = new ExchangedImage;
    image->allocateImage(1, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    stateSet->setAttribute(material);
    stateSet->setAttribute(physical);
    stateSet->setTextureAttributeAndModes(0, texture);
    osg::ref_ptr<osg::LightModel> lightModel = new osg::LightModel;
    osg::ref_ptr<osg::StateSet> inherited = new osg::StateSet;
    inherited->setAttribute(lightModel);
    ViewingConditions conditions;
    conditions.inheritedState = {inherited};

    uint64_t last = graphHash(*root, conditions);
    const auto changed = [&]
    {
        const uint64_t before = last;
        last = graphHash(*root, conditions);
        return last != before;
    };
    CHECK_FALSE(changed());

    SECTION("every parameter of a physical material")
    {
        physical->setAlpha(0.5f);
        CHECK(changed());
        physical->setVertexColors(true);
        CHECK(changed());
        physical->setNormalScale(0.5f);
        CHECK(changed());
        physical->setThinWalled(true);
        CHECK(changed());
        physical->setAttenuationColor(osg::Vec3(0.5f, 1.0f, 1.0f));
        CHECK(changed());
        physical->setAttenuationDistance(2.0f);
        CHECK(changed());
        physical->setSpecular(0.5f);
        CHECK(changed());
        physical->setSpecularColor(osg::Vec3(0.5f, 1.0f, 1.0f));
        CHECK(changed());
        physical->setClearcoat(0.5f);
        CHECK(changed());
        physical->setClearcoatRoughness(0.5f);
        CHECK(changed());
        physical->setSheenColor(osg::Vec3(0.5f, 0.0f, 0.0f));
        CHECK(changed());
        physical->setSheenRoughness(0.5f);
        CHECK(changed());
        physical->setAnisotropy(0.5f);
        CHECK(changed());
        physical->setAnisotropyRotation(0.5f);
        CHECK(changed());
        physical->setDiffuseTransmission(0.5f);
        CHECK(changed());
        physical->setDiffuseTransmissionColor(osg::Vec3(0.5f, 1.0f, 1.0f));
        CHECK(changed());
        physical->setSubsurface(0.5f);
        CHECK(changed());
        physical->setSubsurfaceRadius(osg::Vec3(1.0f, 0.2f, 0.1f));
        CHECK(changed());
        physical->setIridescence(0.5f);
        CHECK(changed());
        physical->setIridescenceIor(1.5f);
        CHECK(changed());
        physical->setIridescenceThicknessMinimum(200.0f);
        CHECK(changed());
        physical->setIridescenceThicknessMaximum(500.0f);
        CHECK(changed());
        physical->setTexture(PhysicalMaterial::SHEEN_COLOR_TEXTURE, texture);
        CHECK(changed());
        PhysicalMaterial::TexturePlace place;
        place.rotation = 0.5f;
        physical->setTexturePlace(PhysicalMaterial::SHEEN_COLOR_TEXTURE, place);
        CHECK(changed());
        CHECK_FALSE(changed());
    }
    SECTION("the graph")
    {
        transform->setMatrix(osg::Matrix::translate(1e-3, 0.0, 0.0));
        CHECK(changed());
        choice->setAllChildrenOff();
        CHECK(changed());
        choice->setAllChildrenOn();
        CHECK(changed());
        geometry->setNodeMask(0);
        CHECK(changed());
        transform->addChild(new osg::Group);
        CHECK(changed());
        root->setChild(0, new osg::Group);
        CHECK(changed());
    }
    SECTION("a node mask that stays visible is no change: frameworks flip bits in every frame")
    {
        conditions.traversalMask = 0x1;
        (void)changed();
        geometry->setNodeMask(0x1 | 0x2000000);
        CHECK_FALSE(changed());
    }
    SECTION("geometry")
    {
        geometry->getVertexArray()->dirty();
        CHECK(changed());
        geometry->getPrimitiveSet(0)->dirty();
        CHECK(changed());
        (*static_cast<osg::Vec3Array*>(geometry->getVertexArray()))[0].set(-1, -1, 0);
        geometry->dirtyBound();
        CHECK(changed());
    }
    SECTION("primitive sets whose setters give no sign")
    {
        osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(GL_TRIANGLES, 0, 1);
        osg::ref_ptr<osg::MultiDrawArrays> several = new osg::MultiDrawArrays(GL_TRIANGLES);
        lengths->front() = 3;
        several->add(0, 3);
        several->add(0, 0);
        geometry->addPrimitiveSet(lengths);
        geometry->addPrimitiveSet(several);
        (void)changed();
        lengths->setFirst(1);
        CHECK(changed());
        several->setFirsts({1, 0});
        CHECK(changed());
        several->setCounts({0, 3}); // no more indices than before
        CHECK(changed());
    }
    SECTION("state")
    {
        material->setDiffuse(osg::Material::FRONT, osg::Vec4(0.1f, 0.2f, 0.3f, 1.0f));
        CHECK(changed());
        physical->setRoughness(0.25f);
        CHECK(changed());
        image->dirty();
        CHECK(changed());
        unsigned char texel[3] = {1, 2, 3};
        unsigned char* other = texel;
        image->exchange(other);
        CHECK(changed());
        image->exchange(other); // the image gets its own data back, which it deletes
        CHECK(changed());
        stateSet->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        CHECK(changed());
        stateSet->setAttribute(material, osg::StateAttribute::OVERRIDE);
        CHECK(changed());
        geometry->getOrCreateStateSet();
        CHECK(changed());
    }
    SECTION("lights")
    {
        lightSource->getLight()->setPosition(osg::Vec4(1, 2, 3, 1));
        CHECK(changed());
        areaLight->setRadiance(osg::Vec3(1, 2, 3));
        CHECK(changed());
        areaLight->setTwoSided(true);
        CHECK(changed());
    }
    SECTION("another texture generator with the values of the one that is gone")
    {
        texGenNode->setTexGen(new osg::TexGen(*texGenNode->getTexGen()));
        CHECK(changed());
    }
    SECTION("levels of detail follow the eye, the rest does not")
    {
        conditions.eye.set(0.0, 0.0, 5.0);
        CHECK_FALSE(changed());
        conditions.eye.set(0.0, 0.0, 50.0);
        CHECK(changed());
    }
    SECTION("inherited state by its values, but not what belongs to the frame")
    {
        lightModel->setAmbientIntensity(osg::Vec4(0.4f, 0.4f, 0.4f, 1.0f));
        CHECK(changed());
        inherited->setAttribute(new osg::Viewport(0, 0, 4, 4));
        CHECK_FALSE(changed());
        conditions.inheritedState = {new osg::StateSet(*inherited)};
        CHECK_FALSE(changed());
    }
}
