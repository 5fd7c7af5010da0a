// Surfaces.cpp - builds quads, spheres and views. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"

#include <osg/ClearNode>
#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/Matrixd>
#include <osg/ShapeDrawable>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::data
{

namespace
{

constexpr float kSphereDetail = 4.0f; ///< 160 segments by 80 rows

float srgbFromLinear(float value)
{
    return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

osg::ref_ptr<osg::Geometry> geometryOf(const Quad& quad, const PhysicalMaterial& material)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(quad.begin(), quad.end());
    osg::Vec3 normal = (quad[1] - quad[0]) ^ (quad[3] - quad[0]);
    normal.normalize();

    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices.get());
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 4));
    geometry->getOrCreateStateSet()->setAttributeAndModes(rasterMaterial(material, normal).get());
    return geometry;
}

/// Returns the rotation that turns the view's right to +x, its line of sight to +y and its up to
/// +z.
osg::Matrixd turnedTo(const SceneView& view)
{
    osg::Vec3d ahead = view.center - view.eye;
    ahead.normalize();
    osg::Vec3d right = ahead ^ view.up;
    right.normalize();
    const osg::Vec3d up = right ^ ahead;
    osg::Matrixd matrix;
    for (int i = 0; i < 3; ++i)
    {
        matrix(i, 0) = right[i] + 0.0; // no negative zeros
        matrix(i, 1) = ahead[i] + 0.0;
        matrix(i, 2) = up[i] + 0.0;
    }
    return matrix;
}

osg::ref_ptr<osg::CameraView> cameraView(const SceneView& stored)
{
    osg::ref_ptr<osg::CameraView> view = new osg::CameraView;
    view->setName("view");
    view->setPosition(stored.eye);
    view->setAttitude(
        osg::Matrixd::lookAt(stored.eye, stored.center, stored.up).getRotate().inverse());
    view->setFieldOfView(stored.fovyDegrees);
    view->setFieldOfViewMode(osg::CameraView::VERTICAL);
    return view;
}

} // namespace

osg::ref_ptr<osg::Material> rasterMaterial(const PhysicalMaterial& physical,
                                           const osg::Vec3& normal)
{
    const osg::Vec3 up(0.35f, 0.8f, 0.5f);
    const float shade = 0.55f + 0.45f * std::abs(normal * up);
    const osg::Vec3& base = physical.getBaseColor();
    const osg::Vec4 color(srgbFromLinear(base.x() * shade), srgbFromLinear(base.y() * shade),
                          srgbFromLinear(base.z() * shade), 1.0f);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, color);
    material->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    return material;
}

osg::ref_ptr<PhysicalMaterial> lambert(const osg::Vec3& albedo)
{
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setBaseColor(albedo);
    material->setIor(1.0f); // no coat
    return material;
}

osg::ref_ptr<PhysicalMaterial> mirror()
{
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setMetallic(1.0f);
    material->setRoughness(0.0f);
    return material;
}

osg::ref_ptr<PhysicalMaterial> metal(const osg::Vec3& color)
{
    osg::ref_ptr<PhysicalMaterial> material = mirror();
    material->setBaseColor(color);
    return material;
}

osg::ref_ptr<PhysicalMaterial> glass(float ior)
{
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setTransmission(1.0f);
    material->setRoughness(0.0f);
    material->setIor(ior);
    return material;
}

osg::ref_ptr<osg::Geode> surface(const std::string& name, const std::vector<Quad>& quads,
                                 PhysicalMaterial* material)
{
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName(name);
    geode->getOrCreateStateSet()->setAttribute(material);
    for (const Quad& quad : quads)
    {
        geode->addDrawable(geometryOf(quad, *material).get());
    }
    return geode;
}

osg::ref_ptr<osg::Geode> sphere(const std::string& name, const osg::Vec3& center, float radius,
                                PhysicalMaterial* material)
{
    osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
    hints->setDetailRatio(kSphereDetail);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName(name);
    geode->addDrawable(new osg::ShapeDrawable(new osg::Sphere(center, radius), hints.get()));
    geode->getOrCreateStateSet()->setAttribute(material);
    geode->getStateSet()->setAttributeAndModes(
        rasterMaterial(*material, osg::Vec3(0.0f, 0.5f, 0.0f)).get());
    return geode;
}

std::vector<Quad> boxQuads(const osg::Vec3& low, const osg::Vec3& high)
{
    const float x0 = low.x(), y0 = low.y(), z0 = low.z();
    const float x1 = high.x(), y1 = high.y(), z1 = high.z();
    return {
        {osg::Vec3(x0, y0, z0), osg::Vec3(x0, y1, z0), osg::Vec3(x1, y1, z0),
         osg::Vec3(x1, y0, z0)},
        {osg::Vec3(x0, y0, z1), osg::Vec3(x1, y0, z1), osg::Vec3(x1, y1, z1),
         osg::Vec3(x0, y1, z1)},
        {osg::Vec3(x0, y0, z0), osg::Vec3(x1, y0, z0), osg::Vec3(x1, y0, z1),
         osg::Vec3(x0, y0, z1)},
        {osg::Vec3(x1, y0, z0), osg::Vec3(x1, y1, z0), osg::Vec3(x1, y1, z1),
         osg::Vec3(x1, y0, z1)},
        {osg::Vec3(x1, y1, z0), osg::Vec3(x0, y1, z0), osg::Vec3(x0, y1, z1),
         osg::Vec3(x1, y1, z1)},
        {osg::Vec3(x0, y1, z0), osg::Vec3(x0, y0, z0), osg::Vec3(x0, y0, z1),
         osg::Vec3(x0, y1, z1)},
    };
}

namespace
{

void makeEmpty(osg::Group& scene, const std::string& name)
{
    scene.setName(name);
    scene.getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    osg::ref_ptr<osg::LightModel> ambient = new osg::LightModel;
    ambient->setAmbientIntensity(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    scene.getStateSet()->setAttribute(ambient.get());

    osg::ref_ptr<osg::ClearNode> background = new osg::ClearNode;
    background->setName("background");
    background->setClearColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    scene.addChild(background.get());
}

} // namespace

osg::ref_ptr<osg::LightSource> sun(const osg::Vec3& towards, const osg::Vec3& color)
{
    osg::ref_ptr<osg::Light> light = new osg::Light(1);
    light->setPosition(osg::Vec4(towards, 0.0f));
    light->setAmbient(osg::Vec4(0, 0, 0, 1));
    light->setDiffuse(osg::Vec4(color, 1));
    light->setSpecular(osg::Vec4(0, 0, 0, 1));
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setName("sun");
    source->setLight(light.get());
    return source;
}

osg::ref_ptr<osg::Group> newGraph(const std::string& name)
{
    osg::ref_ptr<osg::Group> graph = new osg::Group;
    makeEmpty(*graph, name);
    return graph;
}

osg::ref_ptr<osg::MatrixTransform> newScene(const std::string& name, const SceneView& stored,
                                            const SceneView& home)
{
    osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(turnedTo(home));
    makeEmpty(*scene, name);
    scene->setDataVariance(
        osg::Object::DYNAMIC); // osgUtil's optimizer would turn the geometry alone
    const double halfHeight =
        (home.center - home.eye).length() * std::tan(osg::DegreesToRadians(0.5 * home.fovyDegrees));
    scene->setInitialBound(osg::BoundingSphere(home.center * scene->getMatrix(), halfHeight));
    // With this callback the base class adds nothing to the initial bound, in place of the
    // children's bounds.
    scene->setComputeBoundingSphereCallback(new osg::Node::ComputeBoundingSphereCallback);
    scene->setCullingActive(false);
    scene->addChild(cameraView(stored).get());
    return scene;
}

} // namespace osgRayTrace::data
