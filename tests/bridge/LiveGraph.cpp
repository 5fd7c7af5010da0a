// LiveGraph.cpp - a small scene graph that is edited, and a view of it without OpenGL. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/bridge/LiveGraph.h"

#include "tests/Catch.h"

#include <osg/Geometry>

#include <cmath>
#include <utility>

namespace osgRayTrace::test
{

using namespace engine;

namespace
{

constexpr int kSize = 96;
constexpr int kCells = 8; // of a tile, in each direction

osg::ref_ptr<osg::Geometry> newTile()
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
        {
            vertices->push_back(osg::Vec3(0.1f * float(i), 0.1f * float(j), 0.0f));
            coordinates->push_back(osg::Vec2(float(i) / kCells, float(j) / kCells));
        }
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i)
        {
            const GLuint a = GLuint(j * (kCells + 1) + i), c = a + kCells + 1;
            for (const GLuint index : {a, a + 1, c + 1, a, c + 1, c})
                indices->push_back(index);
        }
    osg::ref_ptr<osg::Geometry> tile = new osg::Geometry;
    tile->setDataVariance(osg::Object::DYNAMIC);
    tile->setVertexArray(vertices);
    tile->setTexCoordArray(0, coordinates);
    tile->addPrimitiveSet(indices);
    return tile;
}

View viewOf()
{
    View view;
    view.width = view.height = kSize;
    const osg::Matrixd look = osg::Matrixd::lookAt(
        osg::Vec3d(1.2, -1.5, 4.0), osg::Vec3d(1.2, 0.8, 0.0), osg::Vec3d(0.0, 0.0, 1.0));
    const osg::Matrixd project = osg::Matrixd::perspective(50.0, 1.0, 0.1, 100.0);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
        {
            view.viewFromWorld[column][row] = look(column, row);
            view.clipFromView[column][row] = project(column, row);
        }
    return view;
}

ViewingConditions conditionsOf(const osg::Vec3d& eye)
{
    ViewingConditions conditions;
    conditions.eye = eye;
    return conditions;
}

} // namespace

void deformTile(osg::Geometry& tile, float height)
{
    auto& vertices = static_cast<osg::Vec3Array&>(*tile.getVertexArray());
    for (osg::Vec3& v : vertices)
        v.z() = height * std::sin(9.0f * v.x()) * std::cos(7.0f * v.y());
    vertices.dirty();
}

LiveGraph::LiveGraph()
{
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    paint(40);
    texture->setImage(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    for (int i = 0; i < 3; ++i)
    {
        materials.push_back(new osg::Material);
        materials.back()->setDiffuse(
            osg::Material::FRONT_AND_BACK,
            osg::Vec4(0.3f * float(i), 0.8f, 0.9f - 0.3f * float(i), 1.0f));
    }
    root->addChild(group);
    root->addChild(light);
    root->addChild(hidden);
    root->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    root->getStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    light->getLight()->setPosition(osg::Vec4(1.0f, -1.0f, 3.0f, 1.0f));
    light->getLight()->setDiffuse(osg::Vec4(0.9f, 0.9f, 0.9f, 1.0f));
    hidden->addChild(newTile());
    hidden->setNodeMask(0);
    for (int i = 0; i < kObjects; ++i)
    {
        objects.push_back(newObject(i, double(i % 3), double(i / 3)));
        group->addChild(objects.back());
    }
}

osg::ref_ptr<osg::MatrixTransform> LiveGraph::newObject(int number, double x, double y) const
{
    osg::ref_ptr<osg::MatrixTransform> object =
        new osg::MatrixTransform(osg::Matrixd::translate(x, y, 0.1 * (number % 4)));
    object->addChild(newTile());
    osg::StateSet* state = object->getOrCreateStateSet();
    state->setAttributeAndModes(materials[std::size_t(number) % materials.size()]);
    if (number % 2) state->setTextureAttributeAndModes(0, texture);
    return object;
}

void LiveGraph::deform(int object, float height)
{
    deformTile(geometry(object), height);
}

void LiveGraph::shuffle(int object)
{
    auto& vertices = static_cast<osg::Vec3Array&>(*geometry(object).getVertexArray());
    const std::size_t count = vertices.size();
    for (std::size_t i = 0; i < count; ++i)
        std::swap(vertices[i], vertices[(i * 37 + 11) % count]);
    vertices.dirty();
}

void LiveGraph::dropTriangle(int object)
{
    auto& indices = static_cast<osg::DrawElementsUInt&>(*geometry(object).getPrimitiveSet(0));
    indices.resize(indices.size() - 3);
    indices.dirty();
}

void LiveGraph::paint(int red)
{
    for (int i = 0; i < 16; ++i)
    {
        unsigned char* texel = image->data() + 4 * i;
        texel[0] = static_cast<unsigned char>(red);
        texel[1] = static_cast<unsigned char>(16 * i);
        texel[2] = 128;
        texel[3] = 255;
    }
    image->dirty();
}

LiveView::LiveView(osg::Node* root) : _root(root)
{
    _settings->setThreads(2);
    _settings->setMaxPasses(1000);
    _settings->setKeepUnchanged(false); // images are compared with those of a fresh conversion
    recordEye(osg::Vec3d(1.2, -1.5, 4.0));
    update();
}

void LiveView::recordEye(const osg::Vec3d& eye)
{
    _updater.recordView(nullptr, nullptr, conditionsOf(eye));
}

void LiveView::update()
{
    const Statistics before = statistics();
    _updater.update(_root, *_settings, nullptr);
    const Statistics after = statistics();
    const bool again = before.conversions > 0 && after.conversions > before.conversions;
    if (again && after.ok) CHECK(!after.lastConversionReason.empty());
}

const std::vector<float>& LiveView::image()
{
    _tracer.trace(_updater.version().inputs, viewOf());
    _last = _tracer.radiance();
    return _last;
}

std::vector<float> freshImage(const osg::Node& root, int passes)
{
    LiveView fresh(const_cast<osg::Node*>(&root)); // only reads the graph
    std::vector<float> image;
    for (int i = 0; i < passes; ++i)
        image = fresh.image();
    return image;
}

int differentPixels(const std::vector<float>& a, const std::vector<float>& b)
{
    if (a.size() != b.size()) return -1;
    int count = 0;
    for (std::size_t pixel = 0; pixel < a.size(); pixel += 4)
    {
        bool same = true;
        for (std::size_t c = 0; c < 4; ++c)
            same = same && std::fabs(a[pixel + c] - b[pixel + c]) <=
                               2e-3f * (1.0f + std::fabs(b[pixel + c]));
        count += !same;
    }
    return count;
}

int wrongPixels(LiveView& view, const osg::Node& root)
{
    view.update();
    const std::vector<float> image = view.image();
    const int different = differentPixels(image, freshImage(root, view.passes()));
    return view.statistics().ok && different >= 0 ? different : int(image.size() / 4);
}

} // namespace osgRayTrace::test
