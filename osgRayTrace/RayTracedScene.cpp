// RayTracedScene.cpp - which traversals see the children, and which the drawable. Layer: public
// API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTracedScene>

#include <osgRayTrace/RayIntersector>

#include "osgRayTrace/bridge/common/SceneRoot.h"
#include "osgRayTrace/bridge/graph/CullCapture.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"

#include <osg/NodeVisitor>
#include <osgUtil/CullVisitor>
#include <osgUtil/GLObjectsVisitor>

namespace osgRayTrace
{

namespace
{

/// Makes the drawable count by its bound, although it has no primitives, when near and far planes
/// are computed from what is drawn.
class BoundingVolumeNearFar
{
public:
    explicit BoundingVolumeNearFar(osgUtil::CullVisitor& visitor)
        : _visitor(visitor),
          _mode(visitor.getComputeNearFarMode()),
          _inheritance(visitor.getInheritanceMask())
    {
        if (_mode != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR)
            set(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    }
    ~BoundingVolumeNearFar() { set(_mode); }

private:
    void set(osg::CullSettings::ComputeNearFarMode mode)
    {
        _visitor.setComputeNearFarMode(mode);
        _visitor.setInheritanceMask(_inheritance);
    }

    osgUtil::CullVisitor& _visitor;
    const osg::CullSettings::ComputeNearFarMode _mode;
    const osg::CullSettings::InheritanceMask _inheritance;
};

/// Returns whether a visitor goes through a scene before its first frame and uploads all of it.
/// Textures may be set to let go of their images then, which the ray tracer needs; OSG uploads the
/// parts that it draws when it draws them.
bool uploads(const osg::NodeVisitor& visitor)
{
    const auto* objects = dynamic_cast<const osgUtil::GLObjectsVisitor*>(&visitor);
    constexpr auto kUploads = osgUtil::GLObjectsVisitor::COMPILE_DISPLAY_LISTS |
                              osgUtil::GLObjectsVisitor::COMPILE_STATE_ATTRIBUTES;
    return objects && (objects->getMode() & kUploads);
}

} // namespace

RayTracedScene::RayTracedScene()
    : _children(new engine::SceneRoot(this)), _drawable(new RayTraceDrawable)
{
    _drawable->setScene(_children.get());
    setNumChildrenRequiringUpdateTraversal(1);
}

RayTracedScene::RayTracedScene(const RayTracedScene& other, const osg::CopyOp& copyop)
    : osg::Group(other, copyop),
      _enabled(other._enabled),
      _children(new engine::SceneRoot(this)),
      _drawable(new RayTraceDrawable)
{
    _drawable->setScene(_children.get());
    _drawable->setSettings(other._drawable->_settings.get());
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

RayTracedScene::~RayTracedScene()
{
    static_cast<engine::SceneRoot*>(_children.get())->detach();
    _drawable->releaseScene(); // others may keep the drawable
}

void RayTracedScene::setHint(osg::Node* node, Hint hint)
{
    if (!node) return;
    switch (hint)
    {
    case AUTOMATIC:
        return engine::setOwnHint(*node, engine::DrawHint::Automatic);
    case TRACE:
        return engine::setOwnHint(*node, engine::DrawHint::Trace);
    case RASTERIZE:
        return engine::setOwnHint(*node, engine::DrawHint::Rasterize);
    case RASTERIZE_ONLY:
        return engine::setOwnHint(*node, engine::DrawHint::RasterizeOnly);
    }
}

RayTracedScene::Hint RayTracedScene::getHint(const osg::Node* node)
{
    if (!node) return AUTOMATIC;
    switch (engine::ownHint(*node))
    {
    case engine::DrawHint::Trace:
        return TRACE;
    case engine::DrawHint::Rasterize:
        return RASTERIZE;
    case engine::DrawHint::RasterizeOnly:
        return RASTERIZE_ONLY;
    case engine::DrawHint::None:
    case engine::DrawHint::Automatic:
        break;
    }
    return AUTOMATIC;
}

void RayTracedScene::setEnabled(bool enabled)
{
    _enabled = enabled;
    if (enabled) _drawable->forgetFailure();
}

void RayTracedScene::setSettings(RayTraceSettings* settings)
{
    _drawable->setSettings(settings);
}

RayTraceSettings* RayTracedScene::getSettings()
{
    return _drawable->getSettings();
}

const RayTraceSettings* RayTracedScene::getSettings() const
{
    return static_cast<const RayTraceDrawable*>(_drawable.get())->getSettings();
}

void RayTracedScene::dirtyScene()
{
    _drawable->dirtyScene();
    dirtyBound();
}

std::string RayTracedScene::getConversionReport() const
{
    return conversionReport(_drawable->getStatistics());
}

void RayTracedScene::traverse(osg::NodeVisitor& visitor)
{
    const bool captured = engine::isCapturing(); // below a node of another scene
    osgUtil::CullVisitor* cull = _enabled && !captured ? visitor.asCullVisitor() : nullptr;
    if (cull)
    {
        // This call converts at once if this is the first view, or if there was no update
        // traversal.
        _drawable->recordView(*cull);
        _drawable->updateScene(cull->getFrameStamp());
    }
    if (cull && _drawable->canTrace())
    {
        {
            const BoundingVolumeNearFar nearFar(*cull);
            _drawable->accept(*cull);
        }
        _drawable->cullRasterized(*cull);
        _drawable->requestPages(*this, *cull);
        return;
    }

    if (_enabled && uploads(visitor)) return;
    if (_enabled && pick(visitor)) return;
    osg::Group::traverse(visitor);
    const bool update = visitor.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR;
    if (update && !_enabled) _drawable->releaseScene(); // nobody looks at what is removed
    // Before the first cull the light and the eye are not known: the first cull converts.
    if (update && _enabled && _drawable->isViewed())
        _drawable->updateScene(visitor.getFrameStamp());
}

/// Returns true if the visitor picks with a ray and has its hits.
bool RayTracedScene::pick(osg::NodeVisitor& visitor)
{
    osgUtil::IntersectionVisitor* picks = visitor.asIntersectionVisitor();
    if (!picks || picks->getDoDummyTraversal()) return false;
    auto* ray = dynamic_cast<RayIntersector*>(picks->getIntersector());
    return ray && _drawable->pick(*ray, *picks, getBound());
}

osg::BoundingSphere RayTracedScene::computeBound() const
{
    _drawable->dirtyBound();
    _drawable->getBound(); // computed here: several cull threads may ask for it at once
    return osg::Group::computeBound();
}

void RayTracedScene::releaseGLObjects(osg::State* state) const
{
    _drawable->releaseGLObjects(state);
    osg::Group::releaseGLObjects(state);
}

void RayTracedScene::resizeGLObjectBuffers(unsigned int maxSize)
{
    _drawable->resizeGLObjectBuffers(maxSize);
    osg::Group::resizeGLObjectBuffers(maxSize);
}

} // namespace osgRayTrace
