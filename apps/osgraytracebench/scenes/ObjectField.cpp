// ObjectField.cpp - builds, moves and deforms the objects. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/ObjectField.h"

#include "apps/osgraytracebench/yardsticks/BareTriangles.h"

#include <osg/Texture2D>

#include <cmath>
#include <cstring>

namespace osgRayTrace::bench
{

namespace
{

constexpr unsigned int kColumns = 25, kRows = 20; // quads of two triangles each
constexpr unsigned int kMaterials = 100;
constexpr double kSpacing = 1.25;

float heightAt(float x, float y, double phase)
{
    return 0.1f * static_cast<float>(std::sin(6.0 * x + phase) * std::cos(5.0 * y + phase));
}

osg::ref_ptr<osg::Geometry> newTile()
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    for (unsigned int j = 0; j <= kRows; ++j)
        for (unsigned int i = 0; i <= kColumns; ++i)
        {
            const float x = float(i) / kColumns, y = float(j) / kRows;
            vertices->push_back(osg::Vec3(x, y, heightAt(x, y, 0.0)));
            normals->push_back(osg::Vec3(0.0f, 0.0f, 1.0f));
        }
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int j = 0; j < kRows; ++j)
        for (unsigned int i = 0; i < kColumns; ++i)
        {
            const unsigned int a = j * (kColumns + 1) + i, c = a + kColumns + 1;
            for (const unsigned int index : {a, a + 1, c + 1, a, c + 1, c})
                indices->push_back(index);
        }
    osg::ref_ptr<osg::Geometry> tile = new osg::Geometry;
    tile->setDataVariance(osg::Object::DYNAMIC);
    tile->setUseDisplayList(false);
    tile->setVertexArray(vertices);
    tile->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    tile->addPrimitiveSet(indices);
    return tile;
}

} // namespace

ObjectField::ObjectField(bool shared, unsigned int count)
{
    for (unsigned int i = 0; i < kMaterials; ++i)
    {
        materials.push_back(new osg::Material);
        materials.back()->setDiffuse(osg::Material::FRONT_AND_BACK,
                                     osg::Vec4(0.01f * float(i), 0.5f, 0.5f, 1.0f));
    }
    std::vector<osg::ref_ptr<osg::StateSet>> states;
    for (const osg::ref_ptr<osg::Material>& material : materials)
    {
        states.push_back(new osg::StateSet);
        states.back()->setAttributeAndModes(material);
    }
    image->allocateImage(64, 64, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::memset(image->data(), 200, image->getTotalSizeInBytes());
    states[3]->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    root->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    root->addChild(light);
    osg::ref_ptr<osg::Geometry> tile = newTile();
    transforms.resize(count);
    for (unsigned int i = 0; i < count; ++i)
    {
        if (i > 0 && !shared) tile = newTile();
        transforms[i] = new osg::MatrixTransform(place(i, 0.0));
        transforms[i]->setStateSet(states[i % kMaterials]);
        transforms[i]->addChild(tile);
        root->addChild(transforms[i]);
        geometries.push_back(tile);
    }
}

osg::ref_ptr<osg::MatrixTransform> ObjectField::newObject() const
{
    osg::ref_ptr<osg::MatrixTransform> object = new osg::MatrixTransform(place(5000, 1.0));
    object->setStateSet(transforms.front()->getStateSet());
    object->addChild(newTile());
    return object;
}

osg::Matrixd ObjectField::place(unsigned int object, double height) const
{
    const auto side = static_cast<unsigned int>(std::ceil(std::sqrt(double(count()))));
    return osg::Matrixd::translate(kSpacing * (object % side), kSpacing * (object / side), height);
}

void ObjectField::deform(unsigned int object, double phase)
{
    auto& vertices = static_cast<osg::Vec3Array&>(*geometries[object]->getVertexArray());
    for (osg::Vec3& v : vertices)
        v.z() = heightAt(v.x(), v.y(), phase);
    vertices.dirty();
}

BareField::BareField(const ObjectField& field) : _device(rtcNewDevice(nullptr))
{
    _top = rtcNewScene(_device);
    rtcSetSceneFlags(_top, RTC_SCENE_FLAG_ROBUST);
    _objects.resize(field.count());
    for (unsigned int i = 0; i < field.count(); ++i)
    {
        const osg::Geometry& geometry = *field.geometries[i];
        const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
        const auto& indices =
            static_cast<const osg::DrawElementsUInt&>(*geometry.getPrimitiveSet(0));
        Object& object = _objects[i];
        object.scene = rtcNewScene(_device);
        rtcSetSceneFlags(object.scene,
                         RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
        rtcSetSceneBuildQuality(object.scene,
                                RTC_BUILD_QUALITY_LOW); // Embree refits no scene of higher quality
        object.mesh = newBareTriangles(_device, vertices, indices);
        object.vertices = rtcGetGeometryBufferData(object.mesh, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcSetGeometryBuildQuality(object.mesh, RTC_BUILD_QUALITY_REFIT);
        rtcCommitGeometry(object.mesh);
        rtcAttachGeometry(object.scene, object.mesh);
        rtcCommitScene(object.scene);
        object.instance = rtcNewGeometry(_device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(object.instance, object.scene);
        setTransform(i, field.transforms[i]->getMatrix());
        rtcAttachGeometryByID(_top, object.instance, i);
    }
    rtcCommitScene(_top);
}

BareField::~BareField()
{
    for (const Object& object : _objects)
    {
        rtcReleaseGeometry(object.instance);
        rtcReleaseGeometry(object.mesh);
        rtcReleaseScene(object.scene);
    }
    rtcReleaseScene(_top);
    rtcReleaseDevice(_device);
}

void BareField::build(const ObjectField& field, unsigned int object)
{
    const osg::Geometry& geometry = *field.geometries[object];
    const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
    const auto& indices = static_cast<const osg::DrawElementsUInt&>(*geometry.getPrimitiveSet(0));
    RTCScene scene = rtcNewScene(_device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry mesh = newBareTriangles(_device, vertices, indices);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcCommitScene(scene);
    rtcReleaseGeometry(mesh);
    rtcReleaseScene(scene);
}

void BareField::setTransform(unsigned int object, const osg::Matrixd& m)
{
    float columns[12];
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            columns[3 * column + row] = static_cast<float>(m(column, row));
    RTCGeometry instance = _objects[object].instance;
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(instance);
}

void BareField::move(unsigned int object, const osg::Matrixd& matrix)
{
    setTransform(object, matrix);
    rtcCommitScene(_top);
}

void BareField::deform(const ObjectField& field, unsigned int first, unsigned int step)
{
    for (unsigned int i = first; i < field.count(); i += step)
    {
        const osg::Array& vertices = *field.geometries[i]->getVertexArray();
        std::memcpy(_objects[i].vertices, vertices.getDataPointer(), vertices.getTotalDataSize());
        rtcUpdateGeometryBuffer(_objects[i].mesh, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(_objects[i].mesh);
        rtcCommitScene(_objects[i].scene);
        rtcCommitGeometry(_objects[i].instance); // commits the instance's bounds
    }
    rtcCommitScene(_top);
}

} // namespace osgRayTrace::bench
