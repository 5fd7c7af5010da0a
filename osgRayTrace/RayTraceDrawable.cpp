// RayTraceDrawable.cpp - traces the view of a pass and shows it. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTraceDrawable>

#include "osgRayTrace/DisplayTexture.h"
#include "osgRayTrace/bridge/RenderOptionsFromSettings.h"
#include "osgRayTrace/bridge/SceneUpdater.h"
#include "osgRayTrace/bridge/StatisticsFromEngine.h"
#include "osgRayTrace/bridge/ViewFromMatrices.h"
#include "osgRayTrace/bridge/ViewRegistry.h"
#include "osgRayTrace/bridge/ViewingConditions.h"
#include "osgRayTrace/bridge/WarnOnce.h"
#include "osgRayTrace/session/RenderSession.h"

#include <osg/ComputeBoundsVisitor>
#include <osg/LOD>
#include <osg/Viewport>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>

namespace osgRayTrace
{

namespace
{

/// The accumulated image of one view and what shows it.
struct ViewState
{
    std::mutex mutex; // the view's draw thread; and any thread that asks for its image
    std::shared_ptr<engine::Workers> workers;
    std::unique_ptr<engine::RenderSession> session;
    engine::View view; ///< last traced
    DisplayTexture display;
    // What the display holds:
    int shownPasses = 0;
    engine::ToneMap shownToneMap;
};

struct BoundsVisitor : osg::ComputeBoundsVisitor
{
    BoundsVisitor() : osg::ComputeBoundsVisitor(TRAVERSE_ACTIVE_CHILDREN) {}
    using osg::ComputeBoundsVisitor::apply;

    /// All levels: which one is active depends on the view.
    void apply(osg::LOD& node) override
    {
        for (unsigned int i = 0; i < node.getNumChildren(); ++i)
            node.getChild(i)->accept(*this);
    }
};

struct Rectangle
{
    int x, y, width, height;
};

/// In pixels, as osg::Viewport gives it to OpenGL; no area if there is none.
Rectangle currentViewport(const osg::State& state)
{
    const osg::Viewport* viewport = state.getCurrentViewport();
    if (!viewport) return {};
    return {static_cast<int>(viewport->x()), static_cast<int>(viewport->y()),
            static_cast<int>(viewport->width()), static_cast<int>(viewport->height())};
}

engine::PassIdentity passIdentity(osg::RenderInfo& renderInfo, const Rectangle& viewport)
{
    const osg::State& state = *renderInfo.getState();
    const auto& bins = renderInfo.getRenderBinStack();
    engine::PassIdentity pass;
    pass.camera = renderInfo.getCurrentCamera();
    pass.renderStage = bins.empty() ? nullptr : bins.back()->getStage();
    pass.contextId = state.getContextID();
    pass.frameNumber = state.getFrameStamp() ? state.getFrameStamp()->getFrameNumber() : 0;
    pass.viewport = {viewport.x, viewport.y, viewport.width, viewport.height};
    return pass;
}

/// Distance of the near plane in the middle of the view; of orthographic views, whose near plane may be
/// anywhere, half the height of the picture. 0 if the matrix cannot be inverted.
double nearDistance(const osg::Matrixd& projection)
{
    osg::Matrixd viewFromClip;
    if (!viewFromClip.invert(projection)) return 0.0;
    const bool orthographic = projection(2, 3) == 0.0;
    const osg::Vec3d centre = osg::Vec3d(0.0, 0.0, -1.0) * viewFromClip;
    if (!orthographic) return centre.length();
    return (osg::Vec3d(0.0, 1.0, -1.0) * viewFromClip - centre).length();
}

/// OSG's culling clamps the planes of last frame's projection matrix again, so that the third column of a
/// view at rest wanders by its last digits; an image must go on nevertheless.
bool sameButForRounding(const engine::View& a, const engine::View& b)
{
    constexpr double kTolerance = 1e-9;
    engine::View rounded = a;
    for (int i = 0; i < 4; ++i)
    {
        double& depth = rounded.clipFromView[i][2];
        const double other = b.clipFromView[i][2];
        if (std::abs(depth - other) <= kTolerance * std::abs(other)) depth = other;
    }
    return rounded == b;
}

bool operator==(const engine::ToneMap& a, const engine::ToneMap& b)
{
    return a.exposureEv == b.exposureEv && a.displayReferred == b.displayReferred;
}

} // namespace

struct RayTraceDrawable::Implementation
{
    engine::SceneUpdater scene;
    engine::ViewRegistry<ViewState> views;
    std::atomic<bool> paused{false};

    mutable std::mutex mutex; // draw threads write, any thread reads
    engine::RenderProgress progress; ///< of the view drawn last
    std::shared_ptr<ViewState> lastView;
    std::weak_ptr<const engine::TracedScene> untraceable; ///< failed before it gave any image

    void draw(osg::RenderInfo& renderInfo);
    void trace(ViewState& view, const engine::SceneVersion& version, const engine::View& pass);
    void fillDisplay(ViewState& view, const engine::ToneMap& toneMap);
    void noteFailure(const engine::RenderProgress& made, const engine::SceneVersion& version);
    void fail(engine::StatusCode code, const std::string& message);
};

void RayTraceDrawable::Implementation::draw(osg::RenderInfo& renderInfo)
{
    const osg::State& state = *renderInfo.getState();
    const Rectangle viewport = currentViewport(state);
    if (viewport.width <= 0 || viewport.height <= 0) return;
    const engine::SceneVersion version = scene.version();
    if (!version.scene) return;

    const auto makeView = [] { return std::make_shared<ViewState>(); };
    const std::shared_ptr<ViewState> view = views.acquire(passIdentity(renderInfo, viewport), makeView);
    std::lock_guard<std::mutex> lock(view->mutex);

    const osg::Matrixd& viewMatrix = state.getModelViewMatrix();
    const osg::Matrixd& projection = state.getProjectionMatrix();
    trace(*view, version,
          engine::viewFromMatrices(viewMatrix, projection, viewport.width, viewport.height));
    scene.noteDrawn(renderInfo.getCurrentCamera(), osg::Matrixd::inverse(viewMatrix).getTrans(),
                    nearDistance(projection));
    {
        std::lock_guard<std::mutex> progressLock(mutex);
        progress = view->session->progress();
        lastView = view;
    }
    if (view->shownPasses > 0 && !view->display.draw(renderInfo))
        fail(engine::StatusCode::DeviceFailure, "OpenGL cannot compile the display's shaders");
}

void RayTraceDrawable::Implementation::trace(ViewState& view, const engine::SceneVersion& version,
                                             const engine::View& pass)
{
    if (view.workers != version.workers)
    {
        view.session = std::make_unique<engine::RenderSession>(version.workers);
        view.workers = version.workers;
        view.shownPasses = 0;
    }
    engine::RenderSession& session = *view.session;
    const engine::ToneMap toneMap =
        engine::toneMapFromSettings(*version.settings, version.scene->scene());
    const int passesBefore = view.shownPasses;
    bool restarted = false;
    if (!paused || passesBefore == 0)
    {
        session.setScene(version.scene);
        if (!sameButForRounding(pass, view.view)) view.view = pass;
        session.setView(view.view);
        session.setOptions(engine::renderOptionsFromSettings(*version.settings));

        engine::StopRule rule;
        rule.passes = version.settings->getMaxPasses();
        int left = version.settings->getPassesPerFrame();
        const auto keepGoing = [&left](const engine::RenderProgress&) { return --left > 0; };
        const engine::RenderProgress made = session.render(rule, keepGoing);
        restarted = made.restarted;
        noteFailure(made, version);
    }
    const bool unchanged =
        !restarted && session.progress().passes == passesBefore && toneMap == view.shownToneMap;
    const bool failed = !session.progress().status.ok();
    if (!unchanged && !failed && session.progress().passes > 0) fillDisplay(view, toneMap);
}

void RayTraceDrawable::Implementation::fillDisplay(ViewState& view, const engine::ToneMap& toneMap)
{
    const engine::RenderSession& session = *view.session;
    view.shownPasses = 0; // in case that there is no memory for the images
    view.display.resize(session.width(), session.height());
    session.resolveDisplay(toneMap, view.display.rgba(), view.display.depth());
    view.display.modified();
    view.shownPasses = session.progress().passes;
    view.shownToneMap = toneMap;
}

void RayTraceDrawable::Implementation::noteFailure(const engine::RenderProgress& made,
                                                   const engine::SceneVersion& version)
{
    const engine::Status& status = made.status;
    if (status.ok() || status.code == engine::StatusCode::EmptyScene) return;
    engine::warnOnce(status.message);
    const bool resource = status.code == engine::StatusCode::OutOfMemory ||
                          status.code == engine::StatusCode::DeviceFailure;
    if (!resource || made.passes > 0) return;

    std::lock_guard<std::mutex> lock(mutex);
    untraceable = version.scene;
}

void RayTraceDrawable::Implementation::fail(engine::StatusCode code, const std::string& message)
{
    engine::warnOnce(message);
    std::lock_guard<std::mutex> lock(mutex);
    progress.status = {code, message};
}

RayTraceDrawable::RayTraceDrawable()
    : _settings(new RayTraceSettings), _implementation(std::make_unique<Implementation>())
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setDataVariance(osg::Object::STATIC); // update need not wait for draw: it works on versions
    setCullingActive(false);              // the triangle is no small feature of the scene
    setStateSet(DisplayTexture::createStateSet().get());
}

RayTraceDrawable::RayTraceDrawable(const RayTraceDrawable& other, const osg::CopyOp& copyop)
    : osg::Drawable(other, copyop), _scene(copyop(other._scene.get())), _settings(other._settings),
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
        engine::setImageStatistics(statistics, self.progress);
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
    std::shared_ptr<ViewState> view;
    {
        std::lock_guard<std::mutex> lock(_implementation->mutex);
        view = _implementation->lastView;
    }
    if (!view) return nullptr;
    try
    {
        std::lock_guard<std::mutex> lock(view->mutex);
        if (view->session->progress().passes == 0) return nullptr;
        const std::vector<float> radiance = view->session->resolveRadiance();
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(view->session->width(), view->session->height(), 1, GL_RGBA, GL_FLOAT);
        std::copy(radiance.begin(), radiance.end(), reinterpret_cast<float*>(image->data()));
        return image;
    }
    catch (const std::exception& error)
    {
        engine::warnOnce(std::string("the view's image could not be made: ") + error.what());
        return nullptr;
    }
}

void RayTraceDrawable::setPaused(bool paused)
{
    _implementation->paused = paused;
}

bool RayTraceDrawable::getPaused() const
{
    return _implementation->paused;
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
        _implementation->fail(engine::StatusCode::OutOfMemory, "there is not enough memory for a view");
    }
    catch (const std::exception& error)
    {
        _implementation->fail(engine::StatusCode::DeviceFailure, error.what());
    }
    catch (...)
    {
        _implementation->fail(engine::StatusCode::DeviceFailure, "a view could not be traced");
    }
}

void RayTraceDrawable::releaseGLObjects(osg::State* state) const
{
    for (const std::shared_ptr<ViewState>& view : _implementation->views.states())
        view->display.releaseGLObjects(state);
    osg::Drawable::releaseGLObjects(state);
}

void RayTraceDrawable::resizeGLObjectBuffers(unsigned int maxSize)
{
    for (const std::shared_ptr<ViewState>& view : _implementation->views.states())
        view->display.resizeGLObjectBuffers(maxSize);
    osg::Drawable::resizeGLObjectBuffers(maxSize);
}

void RayTraceDrawable::noteView(osgUtil::CullVisitor& visitor)
{
    osgUtil::RenderStage* stage = visitor.getCurrentRenderStage();
    _implementation->scene.noteView(stage ? stage->getCamera() : nullptr, visitor.getFrameStamp(),
                                    engine::viewingConditions(visitor));
}

bool RayTraceDrawable::isViewed() const
{
    return _implementation->scene.isViewed();
}

bool RayTraceDrawable::canTrace() const
{
    const engine::SceneVersion version = _implementation->scene.version();
    std::lock_guard<std::mutex> lock(_implementation->mutex);
    return version.scene && _implementation->untraceable.lock() != version.scene;
}

} // namespace osgRayTrace
