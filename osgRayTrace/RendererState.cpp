// RendererState.cpp - scene graph to images: convert, build, accumulate. Layer: public API,
// private.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/RendererState.h"

#include "osgRayTrace/PassSumsState.h"
#include "osgRayTrace/PicturePacket.h"
#include "osgRayTrace/PictureText.h"
#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/common/HomeView.h"
#include "osgRayTrace/bridge/common/NodePathText.h"
#include "osgRayTrace/bridge/common/PixelImage.h"
#include "osgRayTrace/bridge/common/SceneRoot.h"
#include "osgRayTrace/bridge/common/ViewFromMatrices.h"
#include "osgRayTrace/bridge/pick/PickIndex.h"
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"

#include "osgRayTrace/sampling/Sampler.h"

#include <osg/Light>

#include <chrono>
#include <cmath>
#include <limits>

namespace osgRayTrace
{

using engine::EngineError;
using engine::StatusCode;

namespace
{

constexpr int64_t kMostPixels = int64_t(1) << 28;

/// Returns the mutex for graphs: osg::Node computes its bound when it is asked for it, and
/// renderers may share a graph.
std::mutex& graphMutex()
{
    static std::mutex mutex;
    return mutex;
}

/// Returns the light of osgViewer's HEADLIGHT mode: osg::Light's default position is (0, 0, 1, 0).
osg::ref_ptr<const osg::Light> viewerHeadlight()
{
    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light->setDiffuse(osg::Vec4(0.8f, 0.8f, 0.8f, 1.0f));
    light->setSpecular(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    return light;
}

/// Returns the text that names an image.
std::string textOf(const RenderedInputs& inputs)
{
    return pictureText({inputs.traced->scene(), *inputs.settings, inputs.view, inputs.projection,
                        inputs.width, inputs.height, inputs.shutterEnd});
}

} // namespace

/// Throws EngineError if there is nothing to render.
void Renderer::Implementation::checkInputs() const
{
    if (!scene && !received)
        throw EngineError(StatusCode::EmptyScene, "there is no scene to render");
    if (width <= 0 || height <= 0)
        throw EngineError(StatusCode::InvalidView, "the image has no pixels");
    if (int64_t(width) * height > kMostPixels)
        throw EngineError(StatusCode::InvalidView, "the image has more than 2^28 pixels");
}

void Renderer::Implementation::render(engine::StopRule rule, double seconds,
                                      const std::function<bool(const Statistics&)>& progress)
{
    checkInputs();
    prepareSession();
    if (!shutter) placeHomeView();
    const std::string shutterEnd = shutter ? openShutter() : std::string();
    if (!shutter) showScene();
    engine::RenderOptions options = engine::renderOptionsFromSettings(*settings);
    options.moving = static_cast<bool>(shutter);
    options.still = !options.moving;
    session->setOptions(options);
    session->setFirstPass(firstPass);
    // The session would forget the cancellation at its first pass.
    if (cancelled) throw EngineError(StatusCode::Cancelled, "the render was cancelled");
    const RenderedInputs inputs{
        traced,    new RayTraceSettings(*settings), viewMatrix, projectionMatrix, width, height,
        shutterEnd};
    if (nextSums) session->resume(checkedSums(inputs));

    engine::setDenoiseStatistics(statistics, engine::DenoiseReport(), 0.0);
    const auto begin = std::chrono::steady_clock::now();
    // The render traces a tile at least, so that it comes to an end, however short the time is.
    if (seconds > 0.0 && wholePasses) rule.seconds = seconds;
    if (seconds > 0.0 && !wholePasses)
        rule.shouldStop = [begin, seconds](int tiles, double ahead)
        {
            const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
            return tiles > 0 && spent.count() + ahead >= seconds;
        };
    const auto keepGoing = [&](const engine::RenderProgress& result)
    {
        rendered = inputs;
        if (cancelled) return false;
        if (!progress) return true;
        engine::setImageStatistics(statistics, result);
        return progress(statistics);
    };
    if (rule.nextPass)
        rule.nextPass = [&, next = std::move(rule.nextPass)]
        {
            rendered = inputs; // it may ask for the picture before the first pass
            return next();
        };
    if (shutter)
        rule.pose = [this](int pass) { pose(engine::momentOf(settings->getSeed(), pass)); };
    const engine::RenderProgress result = session->render(rule, keepGoing);
    if (result.status.code != StatusCode::InvalidView) rendered = inputs;
    engine::setImageStatistics(statistics, result);
    statistics.autoExposure = static_cast<double>(meteredEv());
}

float Renderer::Implementation::meteredEv() const
{
    if (!settings->getAutoExposure() || !session) return 0.0f;
    return session->meteredEv(std::numeric_limits<int>::max()).value_or(0.0f);
}

std::vector<unsigned char> Renderer::Implementation::packPicture()
{
    checkInputs();
    if (shutter)
        throw EngineError(StatusCode::InvalidView,
                          "a shutter shows each pass another scene, and one can be packed");
    prepareSession();
    placeHomeView();
    showScene();
    return packedPicture(
        {traced->scene(), *settings, viewMatrix, projectionMatrix, width, height, {}});
}

void Renderer::Implementation::unpackPicture(const unsigned char* bytes, std::size_t size)
{
    const UnpackedPicture picture = unpackedPicture(bytes, size);
    std::string problem = picture.problem;
    const osg::ref_ptr<RayTraceSettings> tried = new RayTraceSettings(*settings);
    for (const auto& [name, value] : picture.settings)
        if (!tried->set(name, value)) problem = "the bytes have a wrong value of " + name;
    if (!problem.empty()) throw EngineError(StatusCode::InvalidView, problem);
    for (const auto& [name, value] : picture.settings)
        settings->set(name, value);
    scene = nullptr;
    received = picture.scene;
    homeFovyDegrees.reset();
    viewMatrix = picture.view;
    projectionMatrix = picture.projection;
    width = picture.width;
    height = picture.height;
}

/// Returns the sums that render() is to begin with, which are used up. Throws EngineError if they
/// are those of another picture, or damaged.
engine::PassSums Renderer::Implementation::checkedSums(const RenderedInputs& inputs)
{
    const PassSums sums = std::move(*nextSums);
    nextSums.reset();
    const std::string problem = whyNotOf(sums, textOf(inputs));
    if (!problem.empty()) throw EngineError(StatusCode::InvalidView, problem);
    std::optional<engine::PassSums> own = engineSums(sums);
    if (!own) throw EngineError(StatusCode::InvalidView, "the sums of passes are damaged");
    return std::move(*own);
}

engine::ToneMap Renderer::Implementation::toneMap()
{
    engine::ToneMap result = engine::toneMapFromSettings(*settings, traced->scene());
    result.exposureEv += meteredEv();
    return result;
}

osg::ref_ptr<osg::Image> Renderer::Implementation::displayed(const engine::ToneMap& shown)
{
    const osg::ref_ptr<osg::Image> image =
        engine::newPixelImage(session->width(), session->height(), GL_RGBA, GL_UNSIGNED_BYTE);
    if (!image) return image;
    if (denoises())
        engine::presentImage(denoisedImage(), shown, *workers, image->data(), nullptr);
    else
        session->resolveDisplay(shown, image->data(), nullptr);
    return image;
}

/// Returns the text that names the session's image; empty before the first one.
std::string Renderer::Implementation::pictureName() const
{
    return rendered.traced ? textOf(rendered) : std::string();
}

PassSums Renderer::Implementation::passSums() const
{
    std::optional<engine::PassSums> sums = session ? session->passSums() : std::nullopt;
    if (!sums || sums->passes.empty() || !rendered.traced) return {};
    PassSums result = publicSums(std::move(*sums));
    result.picture = pictureName();
    result.displayReferred = rendered.traced->scene().displayReferred;
    result.veiled = rendered.traced->traits().veils;
    return result;
}

/// Returns the path of each instance, after an empty one, by converting the graph with an index of
/// its paths. The index leaves out the two nodes that a RayTracedScene has above a graph.
std::vector<std::string> Renderer::Implementation::idPaths() const
{
    osg::Group* group = scene ? scene->asGroup() : nullptr;
    if (!hasImage() || sceneDirty || !group) return {};
    const osg::ref_ptr<engine::SceneRoot> root = new engine::SceneRoot(group);
    const osg::ref_ptr<engine::SceneRoot> aboveRoot = new engine::SceneRoot(root.get());
    engine::ConversionInput input = conversionInput(convertedFor);
    input.root = aboveRoot.get();
    input.picks = true;

    const std::lock_guard<std::mutex> lock(graphMutex());
    engine::SceneConverter indexing;
    const engine::ConversionResult conversion = indexing.convert(input);
    const engine::PickIndex& index = *conversion.pickIndex;
    std::vector<std::string> paths(conversion.scene->instances.size() + 1);
    std::vector<uint32_t> way;
    for (uint32_t instance = 0; instance + 1 < paths.size(); ++instance)
    {
        const uint32_t last = index.use(instance).path;
        if (last == engine::NodeTree::kNone) continue;
        index.paths().way(last, way);
        osg::NodePath path;
        for (const uint32_t entry : way)
            path.push_back(&index.paths().node(entry));
        paths[instance + 1] = engine::pathText(path);
    }
    return paths;
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
    fresh->setSums(engine::FilmSums::Exact);
    if (traced) fresh->setScene(traced);

    const std::lock_guard<std::mutex> lock(sessionMutex);
    session = std::move(fresh);
}

/// Makes the session show the scene and the view as they are now.
void Renderer::Implementation::showScene()
{
    convertScene();
    session->setView(engine::viewFromMatrices(viewMatrix, projectionMatrix, width, height));
}

/// Brings the scene to a moment while the shutter is open.
void Renderer::Implementation::pose(double moment)
{
    shutter(moment);
    scenePosed = true;
    showScene();
}

/// Begins a new picture, and brings the scene to the moment at which the shutter opens. Returns the
/// text that names what is seen as it closes: pictures that differ in that are not joined.
std::string Renderer::Implementation::openShutter()
{
    session->clear();
    shutter(0.0);
    placeHomeView();
    pose(1.0);
    const std::string end =
        textOf({traced, settings, viewMatrix, projectionMatrix, width, height, {}});
    pose(0.0);
    return std::to_string(engine::memoryHash(end.data(), end.size()));
}

/// Brings traced up to date. The eye counts: levels of detail and the engine's origin depend on it.
void Renderer::Implementation::convertScene()
{
    if (received) return buildReceived();
    osg::Matrixd worldFromView;
    const bool inverted = worldFromView.invert(viewMatrix);
    const osg::Vec3d eye = worldFromView.getTrans();
    if (!inverted || !std::isfinite(eye.x()) || !std::isfinite(eye.y()) || !std::isfinite(eye.z()))
        throw EngineError(StatusCode::InvalidView, "the view matrix cannot be inverted");

    const engine::ReferenceView view{viewMatrix, projectionMatrix, double(width), double(height)};
    const auto materials = materialFile.materials(settings->getMaterials(), sceneDirty);
    const ConversionKey key{eye, view, clearColor, headlight,
                            engine::conversionSettings(*settings, materials)};
    if (traced && !sceneDirty && !scenePosed && key == convertedFor) return;

    const std::lock_guard<std::mutex> lock(graphMutex());
    if (sceneDirty) converter.forget();
    engine::releaseHostArrays();
    const engine::ConversionResult conversion = converter.convert(conversionInput(key));
    traced = engine::TracedScene::build(conversion.scene, workers, traced);
    session->setScene(traced);
    convertedFor = key;
    sceneDirty = scenePosed = false;
    engine::setSceneStatistics(statistics, conversion, *traced);
}

/// Brings traced up to date with a scene that comes from elsewhere.
void Renderer::Implementation::buildReceived()
{
    if (traced && &traced->scene() == received.get()) return;
    traced = engine::TracedScene::build(received, workers, traced);
    session->setScene(traced);
    engine::setSceneStatistics(statistics, engine::ConversionResult(), *traced);
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

} // namespace osgRayTrace
