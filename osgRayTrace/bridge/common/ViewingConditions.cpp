// ViewingConditions.cpp - reads a pass for a conversion. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ViewingConditions.h"

#include <osgRayTrace/TracedLight>

#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Holds a light of the pass as OSG keeps it, with the matrix that takes it to the eye space of the
/// pass.
struct PositionedLight
{
    const osg::Light* light = nullptr;
    osg::Matrixd eyeFromLight;
};

/// Returns the first light, or the last one after it with its number, as OpenGL keeps the last of a
/// number.
PositionedLight firstLight(osgUtil::PositionalStateContainer& container, const osg::Matrixd& toEye)
{
    PositionedLight found;
    for (const auto& [attribute, matrix] : container.getAttrMatrixList())
    {
        const auto* light = dynamic_cast<const osg::Light*>(attribute.get());
        if (!light || dynamic_cast<const TracedLight*>(light) ||
            (found.light && light->getLightNum() != found.light->getLightNum()))
            continue;
        found = {light, matrix ? *matrix * toEye : toEye};
    }
    return found;
}

/// Returns the first light of a stage. SceneView adds its light to the stage before it traverses
/// the graph, with no matrix for a headlight and with the view matrix for a sky light. A camera in
/// the graph inherits the container of its parent stage together with the matrix between the two
/// eye spaces.
PositionedLight firstLight(osgUtil::RenderStage& stage)
{
    PositionedLight found = firstLight(*stage.getPositionalStateContainer(), osg::Matrixd());
    if (!found.light && stage.getInheritedPositionalStateContainer())
        found = firstLight(*stage.getInheritedPositionalStateContainer(),
                           stage.getInheritedPositionalStateContainerMatrix());
    return found;
}

/// Returns a state set that no thread of OSG's changes. A state set of no node is SceneView's own:
/// its draw adds a colour mask while the next update reads, so it is copied in cull, before that
/// draw. State sets of nodes are not copied, so that the next update sees the application's
/// changes.
osg::ref_ptr<const osg::StateSet> unchanging(const osg::StateSet& stateSet)
{
    if (stateSet.getNumParents() > 0) return &stateSet;
    return new osg::StateSet(stateSet, osg::CopyOp::SHALLOW_COPY);
}

std::vector<osg::ref_ptr<const osg::StateSet>> inheritedState(const osgUtil::StateGraph* graph)
{
    std::vector<osg::ref_ptr<const osg::StateSet>> stateSets;
    for (; graph; graph = graph->_parent)
        if (graph->getStateSet()) stateSets.push_back(unchanging(*graph->getStateSet()));
    std::reverse(stateSets.begin(), stateSets.end());
    return stateSets;
}

/// Returns whether two points are equal but for the rounding of numbers of this size.
bool close(const osg::Vec3d& a, const osg::Vec3d& b, double size)
{
    return (a - b).length() <= 1e-5 * size;
}

osg::Vec3d xyz(const osg::Vec4& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Returns whether nobody sees a difference between two display values. A display has 256 steps;
/// what drifts is compared with the value that it had at first.
bool seemsSame(const osg::Vec4& a, const osg::Vec4& b)
{
    constexpr float kStep = 1.0f / 1024.0f;
    for (int i = 0; i < 4; ++i)
        if (a[i] != b[i] && !(std::abs(a[i] - b[i]) < kStep)) return false;
    return true;
}

/// Returns whether two lights have the same place and direction. Positions went through the eye
/// space of their pass, and so
/// were rounded to the precision of the eye's distance.
bool samePlace(const osg::Light& a, const osg::Light& b, const osg::Vec3d& eye)
{
    const osg::Vec3d position = xyz(a.getPosition()), direction(a.getDirection());
    const double w = a.getPosition().w(), eyeDistance = w != 0.0 ? eye.length() : 0.0;
    return std::abs(w - b.getPosition().w()) <= 1e-5 * std::abs(w) &&
           close(position, xyz(b.getPosition()), position.length() + eyeDistance) &&
           close(direction, osg::Vec3d(b.getDirection()), direction.length());
}

bool sameLight(const osg::Light* a, const osg::Light* b, const osg::Vec3d& eye)
{
    if (!a || !b) return a == b;

    if (!samePlace(*a, *b, eye)) return false;
    const osg::ref_ptr<osg::Light> moved = new osg::Light(*b);
    moved->setPosition(a->getPosition());
    moved->setDirection(a->getDirection());
    return a->compare(*moved) == 0;
}

std::optional<ReferenceView> referenceView(osgUtil::CullVisitor& visitor)
{
    const osg::Viewport* viewport = visitor.getViewport();
    if (!viewport || !visitor.getProjectionMatrix()) return std::nullopt;
    return ReferenceView{*visitor.getModelViewMatrix(), *visitor.getProjectionMatrix(),
                         viewport->width(), viewport->height(), visitor.getLODScale()};
}

} // namespace

ViewingConditions viewingConditions(osgUtil::CullVisitor& visitor)
{
    ViewingConditions conditions;
    const osg::Matrixd& eyeFromScene = *visitor.getModelViewMatrix();
    const osg::Matrixd sceneFromEye = osg::Matrixd::inverse(eyeFromScene);
    conditions.eye = sceneFromEye.getTrans();
    conditions.traversalMask = visitor.getTraversalMask();
    conditions.view = referenceView(visitor);
    conditions.inheritedState = inheritedState(visitor.getCurrentStateGraph());

    osgUtil::RenderStage* stage = visitor.getCurrentRenderStage();
    if (!stage) return conditions;
    conditions.clearColor = stage->getClearColor();

    const PositionedLight found = firstLight(*stage);
    if (!found.light) return conditions;
    const osg::ref_ptr<osg::Light> light = new osg::Light(*found.light);
    conditions.lightInEyeSpace = found.eyeFromLight.isIdentity();
    if (!conditions.lightInEyeSpace && found.eyeFromLight != eyeFromScene)
    {
        const osg::Matrixd sceneFromLight = found.eyeFromLight * sceneFromEye;
        light->setPosition(sceneFromLight.preMult(osg::Vec4d(light->getPosition())));
        light->setDirection(
            osg::Matrixd::transform3x3(osg::Vec3d(light->getDirection()), sceneFromLight));
    }
    conditions.light = light;
    return conditions;
}

bool convertAlike(const ViewingConditions& a, const ViewingConditions& b)
{
    if (a.traversalMask != b.traversalMask || a.viewMasks != b.viewMasks ||
        a.lightInEyeSpace != b.lightInEyeSpace || !a.light != !b.light)
        return false;
    // The modes of the state above the scene have the number, and a light in the world has a place.
    return !a.light || (a.light->getLightNum() == b.light->getLightNum() &&
                        (a.lightInEyeSpace || samePlace(*a.light, *b.light, a.eye)));
}

bool keepSame(const ViewingConditions& before, ViewingConditions& now)
{
    const bool sameColor = seemsSame(before.clearColor, now.clearColor);
    if (sameColor) now.clearColor = before.clearColor;
    const bool light = sameLight(before.light.get(), now.light.get(), before.eye);
    if (light) now.light = before.light;
    return sameColor && light;
}

} // namespace osgRayTrace::engine
