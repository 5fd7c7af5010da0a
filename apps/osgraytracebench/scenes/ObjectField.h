// ObjectField.h - ten thousand objects, as a scene graph and in bare Embree. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <embree3/rtcore.h>

#include <osg/Geometry>
#include <osg/Image>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>

#include <vector>

namespace osgRayTrace::bench
{

constexpr unsigned int kFieldObjects = 10000;

/// Holds a square of bumpy tiles of 1,000 triangles, each below a transform of its own, with a
/// hundred materials in turn. shared: all of them are one geometry.
struct ObjectField
{
    explicit ObjectField(bool shared, unsigned int count = kFieldObjects);

    unsigned int nodes() const { return 2 + 2 * count(); }
    unsigned int count() const { return static_cast<unsigned int>(transforms.size()); }
    osg::Matrixd place(unsigned int object, double height) const;

    /// Moves every vertex up or down in place, with dirty(), as an application does.
    void deform(unsigned int object, double phase);

    /// Returns one more object, with the first state and a mesh of its own; it is not added to the
    /// graph.
    osg::ref_ptr<osg::MatrixTransform> newObject() const;

    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    osg::ref_ptr<osg::Image> image = new osg::Image; ///< texture of one of the states
    std::vector<osg::ref_ptr<osg::MatrixTransform>> transforms;
    std::vector<osg::ref_ptr<osg::Geometry>> geometries; ///< geometry of each object
    std::vector<osg::ref_ptr<osg::Material>> materials;
};

/// Holds the objects as instances in Embree, with its flags and qualities for scenes that change.
class BareField
{
public:
    explicit BareField(const ObjectField& field);
    ~BareField();
    BareField(const BareField&) = delete;
    BareField& operator=(const BareField&) = delete;

    /// Builds the BVH of one object, as for a new one.
    void build(const ObjectField& field, unsigned int object);

    /// Sets one transform and commits the top level.
    void move(unsigned int object, const osg::Matrixd& matrix);

    /// Copies the vertices of every step-th object, refits its BVH and commits the top level.
    void deform(const ObjectField& field, unsigned int first, unsigned int step);

private:
    void setTransform(unsigned int object, const osg::Matrixd& matrix);

    struct Object
    {
        RTCScene scene = nullptr;
        RTCGeometry mesh = nullptr;
        RTCGeometry instance = nullptr;
        void* vertices = nullptr;
    };
    RTCDevice _device;
    RTCScene _top;
    std::vector<Object> _objects;
};

} // namespace osgRayTrace::bench
