// RayTraceDrawable.cpp - the drawable in the traversals of OSG. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTraceDrawable>

#include <osgRayTrace/RayIntersector>

#include "osgRayTrace/DrawPass.h"
#include "osgRayTrace/RayTraceDrawableState.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/bridge/graph/CullOutcome.h"
#include "osgRayTrace/bridge/graph/PathBudget.h"
#include "osgRayTrace/bridge/pick/RasterizedPicker.h"
#include "osgRayTrace/bridge/pick/ScenePicker.h"
#include "osgRayTrace/bridge/update/PageRequests.h"

#include <osg/ComputeBoundsVisitor>
#include <osg/LOD>
#include <osg/Projection>
#include <osg/Sequence>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace
{

namespace
{

struct BoundsVisitor : osg::ComputeBoundsVisitor
{
    BoundsVisitor() : osg::ComputeBoundsVisitor(TRAVERSE_ACTIVE_CHILDREN) {}
    using osg::ComputeBoundsVisitor::apply;

    /// A group without children may draw in cull, and have the bound of what it draws.
    void apply(osg::Group& node) override
    {
        if (isTooMuch(node)) return;
        osg::BoundingBox box;
        if (node.getNumChildren() == 0 && engine::cullReason(node)) box.expandBy(node.getBound());
        if (box.valid()) applyBoundingBox(box);
        traverse(node);
    }

    void apply(osg::Transform& node) override
    {
        if (!isTooMuch(node)) osg::ComputeBoundsVisitor::apply(node);
    }

    /// Visits all levels: which level is active depends on the view.
    void apply(osg::LOD& node) override { visitAll(node); }

    /// Visits all children: a sequence moves to the next one without a word to its bound.
    void apply(osg::Sequence& node) override { visitAll(node); }

    /// Leaves out head-up displays: they are in units of their own, and none of what is traced.
    void apply(osg::Projection&) override {}

private:
    void visitAll(osg::Group& node)
    {
        if (isTooMuch(node)) return;
        for (unsigned int i = 0; i < node.getNumChildren(); ++i)
            if (const osg::ref_ptr<osg::Node> child = node.getChild(i)) child->accept(*this);
    }

    /// Returns true after too many paths: the node then counts by its sphere, which OSG keeps.
    bool isTooMuch(osg::Node& node)
    {
        if (_budget.take()) return false;
        osg::BoundingBox box;
        if (node.getBound().valid()) box.expandBy(node.getBound());
        applyBoundingBox(box);
        return true;
    }

    engine::PathBudget _budget;
};

} // namespace

RayTraceDrawable::RayTraceDrawable()
    : _settings(new RayTraceSettings), _implementation(std::make_unique<Implementation>())
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setDataVariance(osg::Object::STATIC); // update need not wait for draw: it works on versions
    setCullingActive(false);              // the triangle is no small feature
    setStateSet(DisplayTexture::createStateSet().get());
}

RayTraceDrawable::RayTraceDrawable(const RayTraceDrawable& other, const osg::CopyOp& copyop)
    : osg::Drawable(other, copyop),
      _scene(copyop(other._scene.get())),
      _settings(other._settings),
      _implementation(std::make_unique<Implementation>())
{
    _implementation->paused = other._implementation->paused.load();
    setStateSet(DisplayTexture::createStateSet().get());
}

RayTraceDrawable::~RayTraceDrawable() = default;

void RayTraceDrawable::setScene(osg::Node* scene)
{
    if (scene == _scene) return;
    _scene = scene;
    releaseScene();
    dirtyScene();
}

void RayTraceDrawable::setSettings(RayTraceSettings* settings)
{
    _settings = settings ? settings : new RayTraceSettings;
}

void RayTraceDrawable::updateScene(const osg::FrameStamp* frameStamp)
{
    _implementation->scene.update(_scene.get(), *_settings, frameStamp);
}

void RayTraceDrawable::dirtyScene()
{
    _implementation->scene.setDirty();
    forgetFailure();
    dirtyBound();
}

Statistics RayTraceDrawable::getStatistics() const
{
    const Implementation& self = *_implementation;
    Statistics statistics = self.scene.statistics();
    const bool converted = statistics.ok;
    const std::string message = statistics.message;
    {
        std::lock_guard<std::mutex> lock(self.mutex);
        engine::setImageStatistics(statistics, self.report.progress);
        engine::setStageStatistics(statistics, self.report.progress.stages);
        statistics.resolutionDivider = self.report.frame.divider;
        statistics.frameSeconds = self.report.frame.seconds;
        statistics.traceSeconds = self.report.frame.traceSeconds;
        const bool background = self.lastView && self.lastView->inBackground();
        statistics.presentation = background ? "background" : "frame-locked";
        statistics.imageAge = self.report.age;
    }
    if (!converted)
    {
        statistics.ok = false;
        statistics.message = message;
    }
    return statistics;
}

osg::ref_ptr<osg::Image> RayTraceDrawable::getColorImage() const
{
    return _implementation->imageOfLastView([](const ViewPresenter& view)
                                            { return view.radiance(); });
}

osg::ref_ptr<osg::Image> RayTraceDrawable::getChannelImage(const std::string& channel) const
{
    const std::optional<engine::Channel> known = engine::channelOf(channel);
    if (!known) return nullptr;
    return _implementation->imageOfLastView([&known](const ViewPresenter& view)
                                            { return view.channel(*known); });
}

void RayTraceDrawable::setPaused(bool paused)
{
    _implementation->paused = paused;
}

bool RayTraceDrawable::getPaused() const
{
    return _implementation->paused;
}

std::optional<FrameWork> RayTraceDrawable::getAffordableWork() const
{
    const double seconds = 1e-3 * double(_settings->getFrameBudget());
    const std::optional<engine::FrameWork> offer =
        _implementation->agreement->offer(seconds, _settings->getDegradeWhileMoving());
    if (!offer) return std::nullopt;
    return FrameWork{offer->divider, offer->passes, offer->progress, offer->upsampleDivider};
}

void RayTraceDrawable::setFrameWork(const std::optional<FrameWork>& work)
{
    if (!work) return _implementation->agreement->impose(std::nullopt);
    const auto clamped = [](int value, int most) { return std::clamp(value, 1, most); };
    constexpr int kMostPasses = 1024, kMostDivider = engine::FramePlanner::kLargestDivider;
    static_assert(FrameWork::WHOLE_PASS == engine::FrameWork::kWholePass);
    _implementation->agreement->impose(
        engine::FrameWork{clamped(work->divider, kMostDivider), clamped(work->passes, kMostPasses),
                          clamped(work->progress, kMostPasses * FrameWork::WHOLE_PASS),
                          clamped(work->upsampleDivider, kMostDivider)});
}

osg::BoundingBox RayTraceDrawable::computeBoundingBox() const
{
    if (!_scene) return osg::BoundingBox();
    BoundsVisitor visitor;
    const_cast<osg::Node*>(_scene.get())->accept(visitor);
    return visitor.getBoundingBox();
}

osg::BoundingSphere RayTraceDrawable::computeBound() const
{
    return osg::BoundingSphere(getBoundingBox());
}

void RayTraceDrawable::drawImplementation(osg::RenderInfo& renderInfo) const
{
    try
    {
        _implementation->draw(renderInfo);
    }
    catch (const std::bad_alloc&)
    {
        _implementation->failToDraw(engine::StatusCode::OutOfMemory,
                                    "there is not enough memory for a view");
    }
    catch (const std::exception& error)
    {
        _implementation->failToDraw(engine::StatusCode::DeviceFailure, error.what());
    }
    catch (...)
    {
        _implementation->failToDraw(engine::StatusCode::DeviceFailure,
                                    "a view could not be traced");
    }
}

void RayTraceDrawable::releaseGLObjects(osg::State* state) const
{
    for (const std::shared_ptr<ViewPresenter>& view : _implementation->views.states())
        view->releaseGLObjects(state);
    if (state) _implementation->views.forgetContext(state->getContextID());
    osg::Drawable::releaseGLObjects(state);
}

void RayTraceDrawable::resizeGLObjectBuffers(unsigned int maxSize)
{
    for (const std::shared_ptr<ViewPresenter>& view : _implementation->views.states())
        view->resizeGLObjectBuffers(maxSize);
    osg::Drawable::resizeGLObjectBuffers(maxSize);
}

void RayTraceDrawable::recordView(osgUtil::CullVisitor& visitor)
{
    osgUtil::RenderStage* stage = visitor.getCurrentRenderStage();
    try
    {
        _implementation->scene.recordView(stage ? stage->getCamera() : nullptr,
                                          visitor.getFrameStamp(),
                                          engine::viewingConditions(visitor), &visitor);
        if (const auto pass = passIdentity(visitor)) _implementation->views.record(*pass);
    }
    catch (const std::exception& error)
    {
        _implementation->fail(engine::StatusCode::OutOfMemory, error.what());
    }
}

bool RayTraceDrawable::isViewed() const
{
    return _implementation->scene.isViewed();
}

bool RayTraceDrawable::canTrace() const
{
    const engine::SceneVersion version = _implementation->scene.version();
    std::lock_guard<std::mutex> lock(_implementation->mutex);
    return version.inputs.scene && _implementation->untraceable.lock() != version.inputs.scene;
}

void RayTraceDrawable::cullRasterized(osgUtil::CullVisitor& visitor) const
{
    const engine::SceneVersion version = _implementation->scene.version();
    if (version.rasterized) engine::cullParts(*version.rasterized, visitor);
}

void RayTraceDrawable::requestPages(osg::Group& scene, osgUtil::CullVisitor& visitor) const
{
    if (_implementation->scene.version().paged) engine::requestPages(scene, visitor);
}

/// Picks in the traced scene; false: osgUtil has to look for hits in the children. bound: bound of
/// the children.
bool RayTraceDrawable::pick(RayIntersector& ray, osgUtil::IntersectionVisitor& visitor,
                            const osg::BoundingSphere& bound)
{
    try
    {
        const osg::ref_ptr<osgUtil::Intersector> clone = ray.clone(visitor);
        const auto& local = static_cast<const osgUtil::LineSegmentIntersector&>(*clone);
        const engine::SceneVersion version =
            _implementation->scene.versionToPick(_scene.get(), *_settings, local.getStart());
        if (!version.inputs.scene || !version.pickIndex) return false;

        engine::HitRule rule;
        rule.solid = !ray.getVisibleOnly();
        rule.culls = rule.keepsBlended = ray.getVisibleOnly();
        engine::ScenePicker picker(*version.inputs.scene, *version.pickIndex, visitor, rule);
        const osgUtil::Intersector::IntersectionLimit limit = ray.getIntersectionLimit();
        auto hits = picker.pick(local.getStart(), local.getEnd(), bound, limit);
        for (auto& hit : engine::pickRasterized(*version.pickIndex, visitor, ray))
            hits.push_back(std::move(hit));
        if (limit == osgUtil::Intersector::LIMIT_ONE ||
            limit == osgUtil::Intersector::LIMIT_NEAREST)
        {
            std::sort(hits.begin(), hits.end());
            if (hits.size() > 1) hits.resize(1);
        }
        for (const auto& hit : hits)
            ray.insertIntersection(hit);
        return true;
    }
    catch (const std::exception& error)
    {
        _implementation->fail(engine::StatusCode::OutOfMemory, error.what());
        return false;
    }
}

/// Lets go of the scene: the drawable keeps no node of it alive until the next updateScene().
void RayTraceDrawable::releaseScene()
{
    try
    {
        _implementation->scene.releaseGraph();
    }
    catch (const std::exception& error)
    {
        engine::warnOnce(std::string("the scene graph is kept in memory: ") + error.what());
    }
}

void RayTraceDrawable::forgetFailure()
{
    for (const std::shared_ptr<ViewPresenter>& view : _implementation->views.states())
        view->forgetFailures();
    std::lock_guard<std::mutex> lock(_implementation->mutex);
    _implementation->untraceable.reset();
}

} // namespace osgRayTrace
