// RendererState.h - what a Renderer is made of. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/Renderer>

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/bridge/geometry/HostArrays.h"
#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/denoise/Denoiser.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace
{

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

/// Holds what the session's image was made of, which may have changed since.
struct RenderedInputs
{
    std::shared_ptr<const engine::TracedScene> traced;
    osg::ref_ptr<const RayTraceSettings> settings;
    osg::Matrixd view, projection;
    int width = 0, height = 0;
    std::string shutterEnd; ///< names what is seen as the shutter closes; empty: there is none
};

struct Renderer::Implementation
{
    osg::ref_ptr<osg::Node> scene;
    std::shared_ptr<const engine::Scene> received; ///< comes from elsewhere, and stands for a graph
    bool sceneDirty = true;  ///< all of the graph may have changed, in any way
    bool scenePosed = false; ///< the graph has changed as a viewer's graph does in update
    osg::Matrixd viewMatrix;
    osg::Matrixd projectionMatrix;
    std::optional<double> homeFovyDegrees; ///< if set, both matrices come from the scene's bound
    int width = 0;
    int height = 0;
    osg::Vec4 clearColor{0.2f, 0.2f, 0.4f, 1.0f};
    bool headlight = true;
    osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;

    int firstPass = 0;
    bool wholePasses = false;
    std::function<int()> passSource;
    std::optional<PassSums> nextSums; ///< sums that the next render() begins with
    std::function<void(double)> shutter;

    Statistics statistics;
    int threads = -1; ///< threads for which the session was made
    std::shared_ptr<engine::Workers> workers;
    engine::HostArraysRelease release; // destroyed after all members that hold arrays
    engine::SceneConverter converter;
    engine::MaterialLibraryFile materialFile;
    ConversionKey convertedFor;
    std::shared_ptr<const engine::TracedScene> traced;
    std::unique_ptr<engine::RenderSession> session;
    RenderedInputs rendered; ///< of the session's image
    engine::Denoiser denoiser;

    /// Guards the session between cancel(), on any thread, and render(), which replaces the
    /// session.
    std::mutex sessionMutex;
    std::atomic<bool> cancelled{false};

    void checkInputs() const;
    std::vector<unsigned char> packPicture();
    void unpackPicture(const unsigned char* bytes, std::size_t size);
    void render(engine::StopRule rule, double seconds,
                const std::function<bool(const Statistics&)>& progress);
    /// Returns the exposure that the mean of the image adds [EV].
    float meteredEv() const;
    engine::PassSums checkedSums(const RenderedInputs& inputs);
    std::string pictureName() const;
    PassSums passSums() const;
    std::vector<std::string> idPaths() const;
    void placeHomeView();
    void prepareSession();
    void convertScene();
    void buildReceived();
    void showScene();
    void pose(double moment);
    std::string openShutter();
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

    /// Returns how the picture is shown, the metered exposure included.
    engine::ToneMap toneMap();

    /// Returns display values multiplied with alpha; null as newPixelImage. Throws std::bad_alloc.
    osg::ref_ptr<osg::Image> displayed(const engine::ToneMap& toneMap);
};

} // namespace osgRayTrace
