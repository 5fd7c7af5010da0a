// ScaledScene.cpp - one scene graph at any place and size, and its pictures. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/stability/scale/ScaledScene.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::test
{

const osg::Vec3d kEye(0.7, -6.3, 3.1), kTarget(0.1, 0.2, 0.6);

namespace
{

class GraphBuilder
{
public:
    explicit GraphBuilder(const Placement& placement)
        : _placement(placement), _root(new osg::Group), _top(_root)
    {
        if (placement.storage != Storage::Local) return;
        const double s = placement.scale;
        const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(
            osg::Matrixd::scale(s, s, s) * osg::Matrixd::translate(placement.offset));
        _root->addChild(transform);
        _top = transform;
    }

    osg::Group& top() { return *_top; }
    osg::ref_ptr<osg::Group> root() const { return _root; }

    osg::Vec3d vector(const osg::Vec3d& v) const
    {
        return _placement.storage == Storage::Local ? v : v * _placement.scale;
    }
    osg::Vec3d point(const osg::Vec3d& p) const
    {
        return _placement.storage == Storage::Local ? p : vector(p) + _placement.offset;
    }

    /// Returns quads of four corners each, with a normal for each corner.
    osg::ref_ptr<osg::Geometry> quads(const std::vector<osg::Vec3d>& corners,
                                      const std::vector<osg::Vec3d>& normals, bool placed) const
    {
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        const osg::ref_ptr<osg::Vec3Array> floats = new osg::Vec3Array;
        const osg::ref_ptr<osg::Vec3dArray> doubles = new osg::Vec3dArray;
        for (const osg::Vec3d& corner : corners)
        {
            const osg::Vec3d p = placed ? point(corner) : vector(corner);
            floats->push_back(p);
            doubles->push_back(p);
        }
        if (_placement.storage == Storage::Double)
            geometry->setVertexArray(doubles);
        else
            geometry->setVertexArray(floats);
        const osg::ref_ptr<osg::Vec3Array> directions = new osg::Vec3Array;
        for (const osg::Vec3d& n : normals)
            directions->push_back(n);
        geometry->setNormalArray(directions, osg::Array::BIND_PER_VERTEX);
        geometry->addPrimitiveSet(
            new osg::DrawArrays(GL_QUADS, 0, static_cast<GLsizei>(corners.size())));
        return geometry;
    }

    osg::ref_ptr<osg::Geometry> quad(const osg::Vec3d& corner, const osg::Vec3d& u,
                                     const osg::Vec3d& v) const
    {
        osg::Vec3d normal = u ^ v;
        normal.normalize();
        return quads({corner, corner + u, corner + u + v, corner + v},
                     std::vector<osg::Vec3d>(4, normal), true);
    }

    /// Returns a box with edges of 1 around its own origin, which is not placed.
    osg::ref_ptr<osg::Geometry> box() const
    {
        std::vector<osg::Vec3d> corners, normals;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0})
            {
                osg::Vec3d n, u, v;
                n[axis] = side;
                u[(axis + 1) % 3] = 1.0;
                v[(axis + 2) % 3] = side;
                for (const osg::Vec3d& p : {n - u - v, n + u - v, n + u + v, n - u + v})
                {
                    corners.push_back(p * 0.5);
                    normals.push_back(n);
                }
            }
        return quads(corners, normals, false);
    }

    osg::ref_ptr<osg::Geometry> ball(const osg::Vec3d& centre, double radius) const
    {
        constexpr int kRows = 24, kColumns = 48;
        const auto direction = [](int row, int column)
        {
            const double theta = osg::PI * row / kRows, phi = 2.0 * osg::PI * column / kColumns;
            return osg::Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                              std::cos(theta));
        };
        std::vector<osg::Vec3d> corners, normals;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column)
                for (const osg::Vec3d& n :
                     {direction(row, column), direction(row + 1, column),
                      direction(row + 1, column + 1), direction(row, column + 1)})
                {
                    corners.push_back(centre + n * radius);
                    normals.push_back(n);
                }
        return quads(corners, normals, true);
    }

    /// Adds a child with a transform of its own: the first factor of its matrix rotates about the
    /// child's origin.
    void addTurned(osg::Node* child, double degrees, const osg::Vec3d& position)
    {
        const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(
            osg::Matrixd::rotate(osg::DegreesToRadians(degrees), osg::Vec3d(0.2, 0.1, 1.0)) *
            osg::Matrixd::translate(point(position)));
        transform->addChild(child);
        _top->addChild(transform);
    }

    osg::Light& addLight(int number, const osg::Vec3d& position, bool eyeSpace)
    {
        const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        osg::Light& light = *source->getLight();
        light.setLightNum(number);
        light.setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
        light.setPosition(
            osg::Vec4(osg::Vec3(eyeSpace ? position * _placement.scale : point(position)), 1.0f));
        if (eyeSpace) source->setReferenceFrame(osg::LightSource::ABSOLUTE_RF);
        _root->getOrCreateStateSet()->setMode(GL_LIGHT0 + static_cast<GLenum>(number),
                                              osg::StateAttribute::ON);
        _top->addChild(source);
        return light;
    }

    /// Sets the attenuation 1 / (c + l d + q d^2) for distances d before placement.
    void attenuate(osg::Light& light, double c, double l, double q) const
    {
        light.setConstantAttenuation(static_cast<float>(c));
        if (!_placement.attenuated) return;
        const double s = _placement.scale;
        light.setLinearAttenuation(static_cast<float>(l / s));
        light.setQuadraticAttenuation(static_cast<float>(q / (s * s)));
    }

private:
    Placement _placement;
    osg::ref_ptr<osg::Group> _root, _top;
};

void setPhysical(osg::Node& node, const osg::Vec3& color, float metallic, float roughness,
                 float transmission, const osg::Vec3& emission = osg::Vec3())
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setBaseColor(color);
    material->setMetallic(metallic);
    material->setRoughness(roughness);
    material->setTransmission(transmission);
    material->setEmission(emission);
    node.getOrCreateStateSet()->setAttribute(material);
}

void setClassic(osg::Node& node, const osg::Vec4& color, float shine)
{
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    material->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(shine, shine, shine, 1.0f));
    material->setShininess(osg::Material::FRONT_AND_BACK, 40.0f);
    node.getOrCreateStateSet()->setAttribute(material);
}

struct Bodies
{
    osg::ref_ptr<osg::Geometry> floor, box, ball;
};

Bodies addBodies(GraphBuilder& graph)
{
    const Bodies bodies{graph.quad({-4.0, -4.0, 0.0}, {8.0, 0.0, 0.0}, {0.0, 8.0, 0.0}),
                        graph.box(), graph.ball({-1.3, 0.4, 0.9}, 0.8)};
    graph.top().addChild(bodies.floor);
    graph.top().addChild(bodies.ball);
    graph.addTurned(bodies.box, 20.0, {0.6, 0.8, 0.7});
    graph.addTurned(bodies.box, -35.0, {1.9, -0.7, 0.7});
    return bodies;
}

std::vector<float> floatsOf(const osg::Image* image)
{
    if (!image) return {};
    const auto* first = reinterpret_cast<const float*>(image->data());
    return {first, first + image->getTotalSizeInBytes() / sizeof(float)};
}

} // namespace

osg::ref_ptr<osg::Group> classicScene(const Placement& placement)
{
    GraphBuilder graph(placement);
    const Bodies bodies = addBodies(graph);
    setClassic(*bodies.floor, osg::Vec4(0.8f, 0.7f, 0.6f, 1.0f), 0.0f);
    setClassic(*bodies.box, osg::Vec4(0.3f, 0.5f, 0.8f, 1.0f), 0.2f);
    setClassic(*bodies.ball, osg::Vec4(0.7f, 0.2f, 0.2f, 1.0f), 0.6f);

    osg::Light& sun = graph.addLight(0, {}, false);
    sun.setPosition(osg::Vec4(0.3f, -0.5f, 1.0f, 0.0f));
    sun.setDiffuse(osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f));
    osg::Light& point = graph.addLight(1, {-2.5, -1.5, 3.0}, false);
    point.setDiffuse(osg::Vec4(0.9f, 0.8f, 0.6f, 1.0f));
    graph.attenuate(point, 0.4, 0.1, 0.05);
    osg::Light& spot = graph.addLight(2, {2.5, -2.0, 3.5}, false);
    spot.setDiffuse(osg::Vec4(0.3f, 0.8f, 0.4f, 1.0f));
    spot.setDirection(osg::Vec3(-0.5f, 0.6f, -1.0f));
    spot.setSpotCutoff(35.0f);
    spot.setSpotExponent(8.0f);
    graph.attenuate(spot, 0.8, 0.05, 0.02);
    osg::Light& lamp = graph.addLight(3, {1.0, 0.5, -0.5}, true);
    lamp.setDiffuse(osg::Vec4(0.4f, 0.4f, 0.7f, 1.0f));
    graph.attenuate(lamp, 0.3, 0.05, 0.03);
    return graph.root();
}

osg::ref_ptr<osg::Group> physicalScene(const Placement& placement)
{
    GraphBuilder graph(placement);
    const Bodies bodies = addBodies(graph);
    setPhysical(*bodies.floor, osg::Vec3(0.8f, 0.7f, 0.6f), 0.0f, 1.0f, 0.0f);
    setPhysical(*bodies.box, osg::Vec3(0.6f, 0.7f, 0.9f), 1.0f, 0.4f, 0.0f);
    setPhysical(*bodies.ball, osg::Vec3(1.0f, 1.0f, 1.0f), 0.0f, 0.0f, 1.0f);
    const osg::ref_ptr<osg::Geometry> panel =
        graph.quad({-3.0, 3.0, 0.2}, {6.0, 0.0, 0.0}, {0.0, 0.0, 1.5});
    setPhysical(*panel, osg::Vec3(0.5f, 0.5f, 0.5f), 0.0f, 1.0f, 0.0f, osg::Vec3(0.8f, 0.4f, 0.2f));
    graph.top().addChild(panel);
    graph.top().addChild(new AreaLight(graph.point({-1.0, -1.0, 4.0}),
                                       graph.vector({0.0, 2.0, 0.0}), graph.vector({2.0, 0.0, 0.0}),
                                       osg::Vec3(4.0f, 4.0f, 4.5f)));
    return graph.root();
}

Picture pictureOf(osg::Node& scene, const Placement& placement, const Recipe& recipe)
{
    const auto placed = [&](const osg::Vec3d& p) { return p * placement.scale + placement.offset; };
    const osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(&scene);
    renderer->setSize(kWidth, kHeight);
    renderer->setHeadlight(false);
    renderer->setViewMatrix(
        osg::Matrixd::lookAt(placed(kEye), placed(kTarget), osg::Vec3d(0.0, 0.0, 1.0)));
    renderer->setProjectionMatrix(osg::Matrixd::perspective(
        kFovyDegrees, double(kWidth) / kHeight, 0.5 * placement.scale, 50.0 * placement.scale));
    renderer->getSettings()->setIntegrator(recipe.integrator);
    renderer->getSettings()->setMaxBounces(recipe.bounces);
    renderer->getSettings()->setMaxPasses(recipe.passes);
    renderer->getSettings()->setThreads(2);
    renderer->getSettings()->setSeed(7);
    renderer->render();

    Picture picture;
    picture.statistics = renderer->getStatistics();
    picture.rgba = floatsOf(renderer->getColorImage());
    picture.depth = floatsOf(renderer->getChannelImage("depth"));
    picture.distance = floatsOf(renderer->getChannelImage("distance"));
    picture.position = floatsOf(renderer->getChannelImage("position"));
    picture.normal = floatsOf(renderer->getChannelImage("normal"));
    picture.id = floatsOf(renderer->getChannelImage("id"));
    return picture;
}

double relativeMse(const Picture& picture, const Picture& reference)
{
    if (picture.rgba.size() != reference.rgba.size() || reference.rgba.empty()) return HUGE_VAL;
    double sum = 0.0;
    for (std::size_t i = 0; i < reference.rgba.size(); ++i)
    {
        if (i % 4 == 3) continue;
        const double x = picture.rgba[i], r = reference.rgba[i];
        sum += (x - r) * (x - r) / (r * r + 0.01);
    }
    return sum / (0.75 * static_cast<double>(reference.rgba.size()));
}

double largestDifference(const Picture& picture, const Picture& reference)
{
    if (picture.rgba.size() != reference.rgba.size() || reference.rgba.empty()) return HUGE_VAL;
    double largest = 0.0;
    for (std::size_t i = 0; i < reference.rgba.size(); ++i)
    {
        const double x = picture.rgba[i], r = reference.rgba[i];
        const double difference = std::abs(x - r) / std::max(r, 0.01);
        if (!(difference <= largest)) largest = difference;
    }
    return largest;
}

bool allFinite(const std::vector<float>& values)
{
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

} // namespace osgRayTrace::test
