// Renderer.cpp - scene graph to images: convert, build, accumulate, resolve. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/Renderer>

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/common/HomeView.h"
#include "osgRayTrace/bridge/common/PixelImage.h"
#include "osgRayTrace/bridge/common/ViewFromMatrices.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/bridge/geometry/HostArrays.h"
#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/denoise/Denoiser.h"

#include <osg/Light>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <new>
#include <optional>

namespace osgRayTrace
{

using engine::EngineError;
using engine::StatusCode;

namespace
{

constexpr int64_t kMostPixels = int64_t(1) << 28;

using Progress = std::function<bool(const Statistics&)>;

/// Returns the mutex for graphs: osg::Node computes its bound when it is asked for it, and
/// renderers may share a graph.
std::mutex& graphMutex()
{
    static std::mutex mutex;
    return mutex;
}

/// Holds all that a conversion depends on beside the graph.
struct ConversionKey
{
    osg::Vec3d eye;
    engine::ReferenceView view;
    osg::Vec4 clearColor;
    bool headlight = true;
    engine::ConversionSettings settings;

    bool operator==(const ConversionKey& other) const
    {
        return eye == other.eye && view == other.view && clearColor == other.clearColor &&
               headlight == other.headlight && settings == other.settings;
    }
};

/// Returns the light of osgViewer's HEADLIGHT mode: osg::Light's default position is (0, 0, 1, 0).
osg::ref_ptr<const osg::Light> viewerHeadlight()
{
    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light->setDiffuse(osg::Vec4(0.8f, 0.8f, 0.8f, 1.0f));
    light->setSpecular(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    return light;
}

struct ChannelName
{
    const char* name;
    engine::Channel channel;
};

constexpr ChannelName kChannels[] = {
    {"depth", engine::Channel::Depth},       {"distance", engine::Channel::Distance},
    {"normal", engine::Channel::Normal},     {"albedo", engine::Channel::Albedo},
    {"position", engine::Channel::Position}, {"id", engine::Channel::Id},
    {"error", engine::Channel::Error},
};

std::optional<engine::Channel> channelOf(const std::string& name)
{
    for (const ChannelName& known : kChannels)
    {
        if (name == known.name) return known.channel;
    }
    return std::nullopt;
}

/// Returns the function's image; null, with a warning, if the function runs out of memory.
template <typename Resolve> osg::ref_ptr<osg::Image> withinMemory(const Resolve& resolve)
{
    try
    {
        return resolve();
    }
    catch (const std::exception& error)
    {
        engine::warnOnce(std::string("an image could not be made: ") + error.what());
        return nullptr;
    }
}

} // namespace

struct Renderer::Implementation
{
    osg::ref_ptr<osg::Node> scene;
    bool sceneDirty = true;
    osg::Matrixd viewMatrix;
    osg::Matrixd projectionMatrix;
    std::optional<double> homeFovyDegrees; ///< if set, both matrices come from the scene's bound
    int width = 0;
    int height = 0;
    osg::Vec4 clearColor{0.2f, 0.2f, 0.4f, 1.0f};
    bool headlight = true;
    osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;

    Statistics statistics;
    int threads = -1; ///< threads for which the session was made
    std::shared_ptr<engine::Workers> workers;
    engine::HostArraysRelease release; // destroyed after all members that hold arrays
    engine::SceneConverter converter;
    engine::MaterialLibraryFile materialFile;
    ConversionKey convertedFor;
    std::shared_ptr<const engine::TracedScene> traced;
    std::unique_ptr<engine::RenderSession> session;
    engine::Denoiser denoiser;

    /// Guards the session between cancel(), on any thread, and render(), which replaces the
    /// session.
    std::mutex sessionMutex;
    std::atomic<bool> cancelled{false};

    void render(engine::StopRule rule, double seconds, const Progress& progress);
    void placeHomeView();
    void prepareSession();
    void convertScene();
    engine::ConversionInput conversionInput(const ConversionKey& key) const;
    bool hasImage() const { return session && session->progress().imageShare > 0.0; }
    /// Returns whether images are denoised. An image with missing tiles is not: single tiles cannot
    /// be denoised.
    bool denoises() const
    {
        return session->progress().passes > 0 &&
               engine::denoiseKind(*settings) != engine::DenoiseKind::Off;
    }
    engine::ResolvedImage denoisedImage();
};

void Renderer::Implementation::render(engine::StopRule rule, double seconds,
                                      const Progress& progress)
{
    if (!scene) throw EngineError(StatusCode::EmptyScene, "there is no scene to render");
    if (width <= 0 || height <= 0)
        throw EngineError(StatusCode::InvalidView, "the image has no pixels");
    if (int64_t(width) * height > kMostPixels)
        throw EngineError(StatusCode::InvalidView, "the image has more than 2^28 pixels");

    placeHomeView();
    prepareSession();
    convertScene();
    session->setView(engine::viewFromMatrices(viewMatrix, projectionMatrix, width, height));
    session->setOptions(engine::renderOptionsFromSettings(*settings));
    // The session would forget the cancellation at its first pass.
    if (cancelled) throw EngineError(StatusCode::Cancelled, "the render was cancelled");

    engine::setDenoiseStatistics(statistics, engine::DenoiseReport(), 0.0);
    const auto begin = std::chrono::steady_clock::now();
    // The render traces a tile at least, so that it comes to an end, however short the time is.
    if (seconds > 0.0)
        rule.shouldStop = [begin, seconds](int tiles, double ahead)
        {
            const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
            return tiles > 0 && spent.count() + ahead >= seconds;
        };
    const auto keepGoing = [this, &progress](const engine::RenderProgress& result)
    {
        if (cancelled) return false;
        if (!progress) return true;
        engine::setImageStatistics(statistics, result);
        return progress(statistics);
    };
    engine::setImageStatistics(statistics, session->render(rule, keepGoing));
}

/// Returns the denoised image and records how long the denoiser took.
engine::ResolvedImage Renderer::Implementation::denoisedImage()
{
    engine::ResolvedImage image = session->resolvedImage();
    const auto begin = std::chrono::steady_clock::now();
    denoiser.forgetSurfaces();
    const auto surfaces = [this]() -> const std::vector<engine::SurfaceSample>&
    { return session->surfaceSamples(); };
    denoiser.denoise(image, engine::denoiseKind(*settings), surfaces, *workers);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    engine::setDenoiseStatistics(statistics, denoiser.report(), time.count());
    return image;
}

/// Sets both matrices to the home view; does nothing if matrices were set, or if there is nothing
/// to look at yet.
void Renderer::Implementation::placeHomeView()
{
    if (!homeFovyDegrees || !scene || width <= 0 || height <= 0) return;
    const std::lock_guard<std::mutex> lock(graphMutex());
    const engine::HomeView home =
        engine::homeView(*scene, *homeFovyDegrees, double(width) / double(height));
    viewMatrix = home.view;
    projectionMatrix = home.projection;
}

void Renderer::Implementation::prepareSession()
{
    if (session && threads == settings->getThreads()) return;
    threads = settings->getThreads();
    workers = std::make_shared<engine::Workers>(threads);
    auto fresh = std::make_unique<engine::RenderSession>(workers);
    if (traced) fresh->setScene(traced);

    const std::lock_guard<std::mutex> lock(sessionMutex);
    session = std::move(fresh);
}

/// Brings traced up to date. The eye counts: levels of detail and the engine's origin depend on it.
void Renderer::Implementation::convertScene()
{
    osg::Matrixd worldFromView;
    const bool inverted = worldFromView.invert(viewMatrix);
    const osg::Vec3d eye = worldFromView.getTrans();
    if (!inverted || !std::isfinite(eye.x()) || !std::isfinite(eye.y()) || !std::isfinite(eye.z()))
        throw EngineError(StatusCode::InvalidView, "the view matrix cannot be inverted");

    const engine::ReferenceView view{viewMatrix, projectionMatrix, double(width), double(height)};
    const auto materials = materialFile.materials(settings->getMaterials(), sceneDirty);
    const ConversionKey key{eye, view, clearColor, headlight,
                            engine::conversionSettings(*settings, materials)};
    if (traced && !sceneDirty && key == convertedFor) return;

    const std::lock_guard<std::mutex> lock(graphMutex());
    if (sceneDirty) converter.forget();
    engine::releaseHostArrays();
    const engine::ConversionResult conversion = converter.convert(conversionInput(key));
    traced = engine::TracedScene::build(conversion.scene, workers, traced);
    session->setScene(traced);
    convertedFor = key;
    sceneDirty = false;
    engine::setSceneStatistics(statistics, conversion, *traced);
}

engine::ConversionInput Renderer::Implementation::conversionInput(const ConversionKey& key) const
{
    engine::ConversionInput input;
    static_cast<engine::ConversionSettings&>(input) = key.settings;
    input.root = scene.get();
    input.eye = key.eye;
    input.view = key.view;
    input.origin = key.eye;
    if (key.headlight) input.viewLight = viewerHeadlight();
    input.clearColor = key.clearColor;
    return input;
}

Renderer::Renderer() : _implementation(std::make_unique<Implementation>()) {}

Renderer::~Renderer() = default;

void Renderer::setScene(osg::Node* scene)
{
    if (_implementation->scene == scene) return;
    _implementation->scene = scene;
    _implementation->sceneDirty = true;
}

void Renderer::setViewMatrix(const osg::Matrixd& matrix)
{
    _implementation->homeFovyDegrees.reset();
    _implementation->viewMatrix = matrix;
}

void Renderer::setProjectionMatrix(const osg::Matrixd& matrix)
{
    _implementation->homeFovyDegrees.reset();
    _implementation->projectionMatrix = matrix;
}

void Renderer::setHomeView(double fovyDegrees)
{
    _implementation->homeFovyDegrees = fovyDegrees;
}

osg::Matrixd Renderer::getViewMatrix() const
{
    _implementation->placeHomeView();
    return _implementation->viewMatrix;
}

osg::Matrixd Renderer::getProjectionMatrix() const
{
    _implementation->placeHomeView();
    return _implementation->projectionMatrix;
}

void Renderer::setSize(int width, int height)
{
    _implementation->width = width;
    _implementation->height = height;
}

void Renderer::setClearColor(const osg::Vec4& color)
{
    _implementation->clearColor = color;
}

void Renderer::setHeadlight(bool on)
{
    _implementation->headlight = on;
}

void Renderer::setSettings(RayTraceSettings* settings)
{
    _implementation->settings = settings ? settings : new RayTraceSettings;
}

RayTraceSettings* Renderer::getSettings()
{
    return _implementation->settings.get();
}

bool Renderer::render(double seconds, double relativeError, const Progress& progress)
{
    Implementation& self = *_implementation;
    self.cancelled = false;
    const auto failed = [&self](const char* message)
    {
        self.statistics.ok = false;
        self.statistics.message = engine::failureText(message);
        return false;
    };

    engine::StopRule rule;
    rule.passes = self.settings->getMaxPasses();
    if (relativeError > 0.0) rule.relativeError = relativeError;
    try
    {
        self.render(rule, seconds, progress);
        return self.statistics.ok;
    }
    catch (const std::bad_alloc&)
    {
        return failed("there is not enough memory");
    }
    catch (const std::exception& error)
    {
        return failed(error.what());
    }
    catch (...)
    {
        return failed("an unknown error occurred");
    }
}

void Renderer::dirtyScene()
{
    _implementation->sceneDirty = true;
}

void Renderer::cancel()
{
    const std::lock_guard<std::mutex> lock(_implementation->sessionMutex);
    _implementation->cancelled = true;
    if (_implementation->session) _implementation->session->cancel();
}

osg::ref_ptr<osg::Image> Renderer::getColorImage() const
{
    Implementation& self = *_implementation;
    if (!self.hasImage()) return nullptr;
    return withinMemory(
        [&self]
        {
            const engine::RenderSession& session = *self.session;
            return engine::pixelImage(self.denoises() ? self.denoisedImage().radiance
                                                      : session.resolveRadiance(),
                                      session.width(), session.height(), GL_RGBA);
        });
}

osg::ref_ptr<osg::Image> Renderer::getDisplayImage() const
{
    Implementation& self = *_implementation;
    if (!self.hasImage()) return nullptr;
    return withinMemory(
        [&self]
        {
            const engine::ToneMap toneMap =
                engine::toneMapFromSettings(*self.settings, self.traced->scene());
            const osg::ref_ptr<osg::Image> image = engine::newPixelImage(
                self.session->width(), self.session->height(), GL_RGBA, GL_UNSIGNED_BYTE);
            if (!image) return image;
            if (self.denoises())
                engine::presentImage(self.denoisedImage(), toneMap, *self.workers, image->data(),
                                     nullptr);
            else
                self.session->resolveDisplay(toneMap, image->data(), nullptr);
            engine::blendOver(*image, self.clearColor);
            return image;
        });
}

osg::ref_ptr<osg::Image> Renderer::getChannelImage(const std::string& channel) const
{
    const Implementation& self = *_implementation;
    const std::optional<engine::Channel> known = channelOf(channel);
    if (!known || !self.hasImage()) return nullptr;
    return withinMemory(
        [&self, &known]
        {
            const engine::RenderSession& session = *self.session;
            const GLenum format = engine::channelSize(*known) == 1 ? GL_LUMINANCE : GL_RGB;
            return engine::pixelImage(session.resolveChannel(*known), session.width(),
                                      session.height(), format);
        });
}

const Statistics& Renderer::getStatistics() const
{
    return _implementation->statistics;
}

} // namespace osgRayTrace
