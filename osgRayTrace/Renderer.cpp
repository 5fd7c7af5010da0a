// Renderer.cpp - the pictures of a scene graph, without OpenGL. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/Renderer>

#include "osgRayTrace/RendererState.h"
#include "osgRayTrace/bridge/common/PixelImage.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"
#include "osgRayTrace/film/Resolve.h"

#include <algorithm>
#include <new>

namespace osgRayTrace
{

using engine::EngineError;
using engine::StatusCode;

namespace
{

using Progress = std::function<bool(const Statistics&)>;

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

/// Calls work. Returns false if that fails, and records why.
template <typename Work> bool attempt(Statistics& statistics, const Work& work)
{
    const auto failed = [&statistics](const char* message)
    {
        statistics.ok = false;
        statistics.message = engine::failureText(message);
        return false;
    };
    try
    {
        work();
        return true;
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

} // namespace

Renderer::Renderer() : _implementation(std::make_unique<Implementation>()) {}

Renderer::~Renderer() = default;

void Renderer::setScene(osg::Node* scene)
{
    if (_implementation->scene == scene && !_implementation->received) return;
    _implementation->received = nullptr;
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

std::vector<unsigned char> Renderer::packPicture()
{
    std::vector<unsigned char> bytes;
    attempt(_implementation->statistics, [&] { bytes = _implementation->packPicture(); });
    return bytes;
}

bool Renderer::unpackPicture(const unsigned char* bytes, std::size_t size)
{
    return attempt(_implementation->statistics,
                   [&] { _implementation->unpackPicture(bytes, size); });
}

bool Renderer::render(double seconds, double relativeError, const Progress& progress)
{
    Implementation& self = *_implementation;
    self.cancelled = false;
    engine::StopRule rule;
    rule.passes = self.settings->getMaxPasses();
    rule.nextPass = self.passSource;
    if (relativeError > 0.0) rule.relativeError = relativeError;
    return attempt(self.statistics, [&] { self.render(rule, seconds, progress); }) &&
           self.statistics.ok;
}

void Renderer::setFirstPass(int pass)
{
    _implementation->firstPass = std::max(pass, 0);
}

void Renderer::setWholePasses(bool on)
{
    _implementation->wholePasses = on;
}

void Renderer::setPassSource(const std::function<int()>& next)
{
    _implementation->passSource = next;
}

void Renderer::setShutter(const std::function<void(double moment)>& pose)
{
    _implementation->shutter = pose;
}

std::string Renderer::getPictureText() const
{
    return _implementation->pictureName();
}

PassSums Renderer::getPassSums() const
{
    try
    {
        return _implementation->passSums();
    }
    catch (const std::exception& error)
    {
        engine::warnOnce(std::string("the sums of passes could not be made: ") + error.what());
        return {};
    }
}

void Renderer::setPassSums(PassSums sums)
{
    _implementation->nextSums = std::move(sums);
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

/// Returns whether an image can stand behind a picture.
static bool isBackground(const osg::Image& image, int width, int height)
{
    return image.data() && image.s() == width && image.t() == height &&
           image.getPixelFormat() == GL_RGBA && image.getDataType() == GL_UNSIGNED_BYTE &&
           image.isDataContiguous();
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
            engine::ToneMap toneMap = self.toneMap();
            engine::setVeiled(self.traced->traits().veils, self.clearColor, toneMap);
            const osg::ref_ptr<osg::Image> image = self.displayed(toneMap);
            if (image) engine::blendOver(*image, self.clearColor);
            return image;
        });
}

osg::ref_ptr<osg::Image> Renderer::getDisplayImage(const osg::Image* background) const
{
    Implementation& self = *_implementation;
    if (!self.hasImage()) return nullptr;
    const int width = self.session->width(), height = self.session->height();
    if (background && !isBackground(*background, width, height)) return nullptr;
    return withinMemory(
        [&]
        {
            const engine::ToneMap toneMap = self.toneMap();
            if (!background || toneMap.displayReferred || !self.traced->traits().veils)
            {
                const osg::ref_ptr<osg::Image> image = self.displayed(toneMap);
                if (image && background) engine::blendOver(*image, *background);
                return image;
            }
            const osg::ref_ptr<osg::Image> image =
                engine::newPixelImage(width, height, GL_RGBA, GL_UNSIGNED_BYTE);
            if (!image) return image;
            const std::vector<float> radiance =
                self.denoises() ? self.denoisedImage().radiance : self.session->resolveRadiance();
            engine::displayOver(radiance.data(), background->data(), radiance.size() / 4, toneMap,
                                image->data());
            return image;
        });
}

osg::ref_ptr<osg::Image> Renderer::getChannelImage(const std::string& channel) const
{
    const Implementation& self = *_implementation;
    const std::optional<engine::Channel> known = engine::channelOf(channel);
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

std::vector<std::string> Renderer::getIdPaths() const
{
    try
    {
        return _implementation->idPaths();
    }
    catch (const std::exception& error)
    {
        engine::warnOnce(std::string("the paths of ids could not be made: ") + error.what());
        return {};
    }
}

const Statistics& Renderer::getStatistics() const
{
    return _implementation->statistics;
}

} // namespace osgRayTrace
