// GraphEditor.cpp - random edits of a scene graph. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/bridge/GraphEditor.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/RayTracedScene>

#include <osg/CullFace>
#include <osg/LOD>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/Switch>
#include <osg/Texture2D>

namespace osgRayTrace::test
{

namespace
{

constexpr int kCells = 3; // of a tile, in each direction
constexpr unsigned int kMostObjects = 10;

osg::StateSet* ownState(osg::Node& node)
{
    return node.getOrCreateStateSet();
}

struct NoDraw : osg::Drawable::DrawCallback
{
    void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
    {
        drawable->drawImplementation(info);
    }
};

} // namespace

GraphEditor::GraphEditor(osg::Group& root, uint32_t seed)
    : _objects(new osg::Group),
      _lamps(new osg::Group),
      _switch(new osg::Switch),
      _levels(new osg::LOD),
      _random(seed)
{
    root.addChild(_objects);
    root.addChild(_lamps);
    root.addChild(_switch);
    root.addChild(_levels);
    for (int i = 0; i < 5; ++i)
        _objects->addChild(newObject());
    for (int i = 0; i < 2; ++i)
        _switch->addChild(newObject());
    static_cast<osg::LOD&>(*_levels).addChild(newObject(), 0.0f, 1e6f);
    static_cast<osg::LOD&>(*_levels).setCenter(osg::Vec3());
    static_cast<osg::LOD&>(*_levels).setRadius(4.0f);
    _lamps->addChild(newLamp());
}

osg::ref_ptr<osg::Vec3Array> GraphEditor::newPositions()
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    const float height = 0.3f * shade();
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
            positions->push_back(
                osg::Vec3(float(i) / kCells, float(j) / kCells, (i + j) % 2 ? height : 0.0f));
    return positions;
}

/// Returns triangles of one of two classes, whose objects have one size.
osg::ref_ptr<osg::PrimitiveSet> GraphEditor::newTriangles()
{
    const bool wide = number(2);
    osg::ref_ptr<osg::DrawElements> triangles =
        wide ? static_cast<osg::DrawElements*>(new osg::DrawElementsUInt(GL_TRIANGLES))
             : new osg::DrawElementsUShort(GL_TRIANGLES);
    const int rows = 1 + int(number(kCells));
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < kCells; ++i)
        {
            const unsigned int a = unsigned(j * (kCells + 1) + i), c = a + kCells + 1;
            for (const unsigned int index : {a, a + 1, c + 1, a, c + 1, c})
                triangles->addElement(index);
        }
    return triangles;
}

/// Returns an array of one of four classes, whose objects have one size.
osg::ref_ptr<osg::Array> GraphEditor::newColors()
{
    const osg::Vec4 color(shade(), shade(), shade(), 1.0f);
    switch (number(3))
    {
    case 0:
        return new osg::Vec4Array(osg::Array::BIND_OVERALL, 1, &color);
    case 1:
    {
        osg::ref_ptr<osg::Vec3Array> colors = new osg::Vec3Array(osg::Array::BIND_OVERALL, 1);
        colors->front() = osg::Vec3(color.r(), color.g(), color.b());
        return colors;
    }
    default:
    {
        osg::ref_ptr<osg::Vec4ubArray> colors = new osg::Vec4ubArray(osg::Array::BIND_OVERALL, 1);
        colors->front().set(static_cast<unsigned char>(number(256)), 40, 90, 255);
        return colors;
    }
    }
}

osg::ref_ptr<osg::Array> GraphEditor::newCoordinates()
{
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    const float scale = float(1 + number(3));
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
            coordinates->push_back(osg::Vec2(scale * float(i) / kCells, scale * float(j) / kCells));
    return coordinates;
}

osg::ref_ptr<osg::Node> GraphEditor::newGeometry()
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setDataVariance(osg::Object::DYNAMIC);
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(newPositions());
    geometry->setTexCoordArray(0, newCoordinates());
    if (number(2)) geometry->setColorArray(newColors());
    geometry->addPrimitiveSet(newTriangles());
    return geometry;
}

void GraphEditor::paint(osg::Image& image)
{
    for (unsigned int i = 0; i < image.getTotalSizeInBytes(); i += 4)
    {
        unsigned char* texel = image.data() + i;
        texel[0] = static_cast<unsigned char>(number(256));
        texel[1] = static_cast<unsigned char>(8 * i);
        texel[2] = 128;
        texel[3] = 255;
    }
}

osg::ref_ptr<osg::Image> GraphEditor::newImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setDataVariance(osg::Object::DYNAMIC);
    image->allocateImage(4, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    paint(*image);
    return image;
}

osg::ref_ptr<osg::StateAttribute> GraphEditor::newTexture()
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(newImage());
    texture->setDataVariance(osg::Object::DYNAMIC);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

osg::ref_ptr<osg::StateSet> GraphEditor::newState()
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setDataVariance(osg::Object::DYNAMIC);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDataVariance(osg::Object::DYNAMIC);
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(shade(), shade(), shade(), 1.0f));
    if (number(4)) state->setAttributeAndModes(material);
    if (number(2)) state->setTextureAttributeAndModes(0, newTexture());
    if (number(4) == 0) state->setAttributeAndModes(new osg::CullFace);
    return state;
}

void GraphEditor::place(osg::Node& node)
{
    // Each tile has a height of its own, so that no two tiles lie in one plane.
    const osg::Vec3d at(2.4 * real() - 1.7, 2.4 * real() - 1.7, 1.5 * real());
    if (auto* matrix = dynamic_cast<osg::MatrixTransform*>(&node))
        matrix->setMatrix(osg::Matrixd::rotate(0.3 * real(), 1.0, 0.0, 0.0) *
                          osg::Matrixd::translate(at));
    else if (auto* placed = dynamic_cast<osg::PositionAttitudeTransform*>(&node))
        placed->setPosition(at);
}

osg::ref_ptr<osg::Node> GraphEditor::newObject()
{
    osg::ref_ptr<osg::Group> object;
    if (number(2))
        object = new osg::MatrixTransform;
    else
        object = new osg::PositionAttitudeTransform;
    object->setDataVariance(osg::Object::DYNAMIC);
    place(*object);
    if (number(3)) object->setStateSet(newState());
    object->addChild(newGeometry());
    if (number(5) == 0) object->addChild(newGeometry());
    return object;
}

/// Returns a lamp of one of three classes; two of them are leaves of about one size.
osg::ref_ptr<osg::Node> GraphEditor::newLamp()
{
    switch (number(3))
    {
    case 0:
    {
        const osg::Vec3 corner(-1.0f, -1.0f, 4.0f + shade()), radiance(5.0f, 5.0f + shade(), 5.0f);
        return new AreaLight(corner, osg::Vec3(0.0f, 1.0f, 0.0f), osg::Vec3(1.0f, 0.0f, 0.0f),
                             radiance);
    }
    case 1:
        return new EnvironmentLight(newImage());
    default:
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->getLight()->setPosition(osg::Vec4(shade(), shade(), 3.0f, 1.0f));
        source->setDataVariance(osg::Object::DYNAMIC);
        return source;
    }
    }
}

osg::Group& GraphEditor::anyGroup()
{
    switch (number(6))
    {
    case 0:
        return *_switch;
    case 1:
        return *_levels;
    default:
        return *_objects;
    }
}

osg::Group& GraphEditor::anyObject()
{
    osg::Group& group = anyGroup();
    if (group.getNumChildren() == 0) return *_switch->getChild(0)->asGroup();
    return *group.getChild(number(group.getNumChildren()))->asGroup();
}

/// Returns null if the object has lost its geometry.
osg::Geometry* GraphEditor::anyGeometry()
{
    osg::Group& object = anyObject();
    if (object.getNumChildren() == 0) return nullptr;
    return object.getChild(number(object.getNumChildren()))->asGeometry();
}

/// Releases the old child before the new one is created.
void GraphEditor::replaceChild(osg::Group& group, unsigned int child, NodeMaker make)
{
    if (child >= group.getNumChildren()) return;
    // The old child makes room in its place, so that the group's number of children never changes.
    group.setChild(child, new osg::Group);
    const osg::ref_ptr<osg::Node> fresh = (this->*make)();
    group.setChild(child, fresh);
}

void GraphEditor::setHint(osg::Node& node)
{
    node.setUserDataContainer(nullptr);
    if (number(2)) node.setUserValue("note", int(number(9)));
    if (number(6) == 0) RayTracedScene::setHint(&node, RayTracedScene::TRACE);
}

void GraphEditor::edit()
{
    _last = int(number(kKinds));
    osg::Group& object = anyObject();
    osg::Geometry* const geometry = anyGeometry();
    switch (_last)
    {
    case 0: // a child is removed and another added: the group's list is as long as before
        _lamps->removeChildren(0, 1);
        _lamps->addChild(newLamp());
        break;
    case 1:
        replaceChild(*_objects, number(kMostObjects), &GraphEditor::newObject);
        break;
    case 2:
        if (_objects->getNumChildren() > 3)
        {
            _objects->removeChild(number(_objects->getNumChildren()));
            _objects->addChild(newObject());
        }
        break;
    case 3:
        replaceChild(object, number(2), &GraphEditor::newGeometry);
        break;
    case 4:
        if (!geometry) break;
        geometry->setVertexArray(nullptr);
        geometry->setVertexArray(newPositions());
        break;
    case 5:
        if (!geometry) break;
        geometry->setColorArray(nullptr);
        if (number(4)) geometry->setColorArray(newColors());
        break;
    case 6:
        if (!geometry) break;
        geometry->removePrimitiveSet(0, geometry->getNumPrimitiveSets());
        geometry->addPrimitiveSet(newTriangles());
        break;
    case 7:
        object.setStateSet(nullptr);
        object.setStateSet(newState());
        break;
    case 8:
        ownState(object)->removeAttribute(osg::StateAttribute::MATERIAL);
        if (number(3))
        {
            osg::ref_ptr<osg::Material> material = new osg::Material;
            material->setDataVariance(osg::Object::DYNAMIC);
            material->setDiffuse(osg::Material::FRONT_AND_BACK,
                                 osg::Vec4(shade(), shade(), shade(), 1.0f));
            ownState(object)->setAttributeAndModes(material);
        }
        break;
    case 9:
        ownState(object)->removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
        ownState(object)->setTextureAttributeAndModes(0, newTexture());
        break;
    case 10:
    {
        auto* texture = dynamic_cast<osg::Texture2D*>(
            ownState(object)->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        if (!texture) break;
        texture->setImage(nullptr);
        texture->setImage(newImage());
        break;
    }
    case 11:
        object.setNodeMask(object.getNodeMask() ? 0u : 0xffffffffu);
        break;
    case 12: // a hidden object is replaced
    {
        const unsigned int child = number(kMostObjects);
        if (child >= _objects->getNumChildren() || _objects->getChild(child)->getNodeMask()) break;
        replaceChild(*_objects, child, &GraphEditor::newObject);
        _objects->getChild(child)->setNodeMask(number(2) ? 0u : 0xffffffffu);
        break;
    }
    case 13:
        if (_objects->getNumChildren() < kMostObjects) _objects->addChild(newObject());
        break;
    case 14:
        if (_objects->getNumChildren() > 2)
            _objects->removeChild(number(_objects->getNumChildren()));
        break;
    case 15:
        place(object);
        break;
    case 16: // an existing tile gets one more path
    {
        if (_objects->getNumChildren() >= kMostObjects || object.getNumChildren() == 0) break;
        osg::ref_ptr<osg::MatrixTransform> other = new osg::MatrixTransform;
        other->setDataVariance(osg::Object::DYNAMIC);
        place(*other);
        other->addChild(object.getChild(0));
        _objects->insertChild(number(_objects->getNumChildren() + 1), other);
        break;
    }
    case 17:
    {
        const unsigned int child = number(2);
        osg::Switch& choice = static_cast<osg::Switch&>(*_switch);
        choice.setValue(child, !choice.getValue(child));
        if (!choice.getValue(child)) replaceChild(choice, child, &GraphEditor::newObject);
        break;
    }
    case 18:
        replaceChild(*_levels, 0, &GraphEditor::newObject);
        break;
    case 19:
    {
        if (!geometry || !geometry->getVertexArray()) break;
        auto& positions = static_cast<osg::Vec3Array&>(*geometry->getVertexArray());
        const float height = 0.3f * shade();
        for (osg::Vec3& p : positions)
            p.z() = p.x() * height;
        positions.dirty();
        geometry->dirtyBound();
        break;
    }
    case 20:
        setHint(object);
        if (geometry) setHint(*geometry);
        break;
    case 21:
    {
        if (!geometry) break;
        geometry->setDrawCallback(nullptr);
        if (number(4) == 0) geometry->setDrawCallback(new NoDraw);
        if (auto* source = dynamic_cast<osg::LightSource*>(
                _lamps->getNumChildren() ? _lamps->getChild(0) : nullptr))
        {
            source->setLight(nullptr);
            source->setLight(new osg::Light);
            source->getLight()->setPosition(osg::Vec4(shade(), shade(), 3.0f, 1.0f));
        }
        break;
    }
    }
}

} // namespace osgRayTrace::test
