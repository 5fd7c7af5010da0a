// AreaLight.cpp - the parameters, and the quad that OpenGL draws for them. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/AreaLight>

#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osg/BoundingBox>
#include <osg/CullFace>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace
{

namespace
{

bool isFinite(const osg::Vec3& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

float shown(float radiance)
{
    return engine::srgbFromLinear(std::clamp(radiance, 0.0f, 1.0f));
}

/// Returns the corners in the order of a triangle strip: its first triangle is (corner, U, V), so
/// that the front faces cross(U, V).
std::array<osg::Vec3, 4> corners(const AreaLight& light)
{
    const osg::Vec3& corner = light.getCorner();
    return {corner, corner + light.getEdgeU(), corner + light.getEdgeV(),
            corner + light.getEdgeU() + light.getEdgeV()};
}

/// Returns state that keeps the quad unlit and untextured, whatever the state above says. Each call
/// makes a new StateSet: optimizers share equal state sets.
osg::ref_ptr<osg::StateSet> quadState(bool twoSided)
{
    const auto off = osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED;
    const auto on = osg::StateAttribute::ON | osg::StateAttribute::PROTECTED;
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setMode(GL_LIGHTING, off);
    state->setTextureMode(0, GL_TEXTURE_2D, off);
    state->setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK), twoSided ? off : on);
    return state;
}

} // namespace

AreaLight::AreaLight() : _geometry(new osg::Geometry), _anchor(new osg::MatrixTransform)
{
    // osgUtil::Optimizer folds static transforms into the geometry below them, as osgviewer has it
    // do, and would leave this node's own vectors behind. The optimizer spares a transform that has
    // another transform below.
    _anchor->setDataVariance(osg::Object::DYNAMIC);
    _anchor->addChild(_geometry);

    _geometry->setDataVariance(osg::Object::DYNAMIC);
    _geometry->setUseDisplayList(false);
    _geometry->setUseVertexBufferObjects(true);
    _geometry->setVertexArray(new osg::Vec3Array(4));
    _geometry->setNormalArray(new osg::Vec3Array(osg::Array::BIND_OVERALL, 1));
    _geometry->setColorArray(new osg::Vec4Array(osg::Array::BIND_OVERALL, 1));
    _geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
    _geometry->setStateSet(quadState(_twoSided));
    updateGeometry();
}

AreaLight::AreaLight(const osg::Vec3& corner, const osg::Vec3& edgeU, const osg::Vec3& edgeV,
                     const osg::Vec3& radiance)
    : AreaLight()
{
    setCorner(corner);
    setEdgeU(edgeU);
    setEdgeV(edgeV);
    setRadiance(radiance);
}

AreaLight::AreaLight(const AreaLight& other, const osg::CopyOp& copyop)
    : osg::Node(other, copyop),
      _corner(other._corner),
      _edgeU(other._edgeU),
      _edgeV(other._edgeV),
      _radiance(other._radiance),
      _twoSided(other._twoSided)
{
    const osg::ref_ptr<AreaLight> fresh = new AreaLight;
    _geometry = fresh->_geometry;
    _anchor = fresh->_anchor;
    _geometry->setStateSet(quadState(_twoSided));
    updateGeometry();
}

AreaLight::~AreaLight() = default;

void AreaLight::setCorner(const osg::Vec3& value)
{
    setVector("corner", _corner, value);
}

void AreaLight::setEdgeU(const osg::Vec3& value)
{
    setVector("first edge", _edgeU, value);
}

void AreaLight::setEdgeV(const osg::Vec3& value)
{
    setVector("second edge", _edgeV, value);
}

void AreaLight::setRadiance(const osg::Vec3& value)
{
    const osg::Vec3 clamped(std::max(value.x(), 0.0f), std::max(value.y(), 0.0f),
                            std::max(value.z(), 0.0f));
    if (isFinite(value) && clamped != value)
        engine::warnOnce("AreaLight '" + getName() + "': negative radiance, clamped to 0");
    setVector("radiance", _radiance, isFinite(value) ? clamped : value);
}

void AreaLight::setTwoSided(bool value)
{
    if (_twoSided == value) return;
    _twoSided = value;
    _geometry->setStateSet(quadState(_twoSided));
}

void AreaLight::setVector(const char* name, osg::Vec3& member, const osg::Vec3& value)
{
    if (!isFinite(value))
    {
        engine::warnOnce("AreaLight '" + getName() + "': " + name +
                         " is not finite, left as it was");
        return;
    }
    member = value;
    updateGeometry();
}

void AreaLight::updateGeometry()
{
    auto& vertices = static_cast<osg::Vec3Array&>(*_geometry->getVertexArray());
    auto& normals = static_cast<osg::Vec3Array&>(*_geometry->getNormalArray());
    auto& colors = static_cast<osg::Vec4Array&>(*_geometry->getColorArray());

    const auto points = corners(*this);
    std::copy(points.begin(), points.end(), vertices.begin());
    normals[0] = _edgeU ^ _edgeV;
    normals[0].normalize();
    colors[0].set(shown(_radiance.x()), shown(_radiance.y()), shown(_radiance.z()), 1.0f);

    vertices.dirty();
    normals.dirty();
    colors.dirty();
    _geometry->dirtyBound();
    dirtyBound();
}

void AreaLight::traverse(osg::NodeVisitor& visitor)
{
    _anchor->accept(visitor);
}

osg::BoundingSphere AreaLight::computeBound() const
{
    osg::BoundingBox box;
    for (const osg::Vec3& point : corners(*this))
    {
        box.expandBy(point);
    }
    return osg::BoundingSphere(box);
}

void AreaLight::releaseGLObjects(osg::State* state) const
{
    osg::Node::releaseGLObjects(state);
    _anchor->releaseGLObjects(state);
}

void AreaLight::resizeGLObjectBuffers(unsigned int maxSize)
{
    osg::Node::resizeGLObjectBuffers(maxSize);
    _anchor->resizeGLObjectBuffers(maxSize);
}

} // namespace osgRayTrace
