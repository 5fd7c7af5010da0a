// Options.h - the values of the command line. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Frames.h"
#include "apps/common/Backdrop.h"
#include "apps/common/ViewText.h"

#include <osgRayTrace/RayTraceSettings>
#include <osgRayTrace/SceneLights>

#include <osg/AnimationPath>
#include <osg/Vec3d>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::app
{

enum class Context
{
    None,
    OsMesa,
    Egl,
};

/// A part of the picture [pixels], from its left and its top.
struct Crop
{
    int left = 0, top = 0;
    int fullWidth = 0, fullHeight = 0; ///< of the picture
};

struct Options
{
    std::vector<std::string> models;
    std::vector<std::string> outputs;
    int width = 1280; ///< [pixels]
    int height = 720; ///< [pixels]

    std::optional<Crop> crop; ///< width and height are then those of the part

    // The following members describe the view; members that are not given are taken from the scene:
    // see Camera.h.
    std::string camera; ///< name of a camera of the scene, or a file; empty: none is asked for
    ViewOptions view;

    osg::ref_ptr<osg::AnimationPath> cameraPath; ///< null: the view stands
    int turnFrames = 0;   ///< frames of a turn around the view's centre; 0: it stands
    double shutter = 0.0; ///< time that the shutter is open [s]; 0: pictures are of a moment

    SceneLights lights; ///< beside those of the models
    Backdrop backdrop;  ///< behind the picture, in place of the clear colour

    double at = 0.0;                  ///< time that the scene is shown at [s]
    double afterFrame = 0.0;          ///< how much later that is than the frame's own time [s]
    std::optional<FrameRange> frames; ///< nothing: one picture
    double framesPerSecond = 25.0;
    bool skipsExisting = false; ///< frames whose files are there are not rendered

    int firstPass = 0;               ///< passes before it are left to others
    std::string checkpoint;          ///< file that keeps the sums of passes; empty: none
    double interval = 60.0;          ///< time between two writings of the checkpoint [s]
    std::vector<std::string> merged; ///< checkpoints to join; empty: a picture is rendered

    bool mpi = false;        ///< whether the processes that mpirun has started share the passes
    bool sendsScene = false; ///< whether rank 0 alone reads the models, and sends the scene

    double seconds = 0.0;       ///< 0: no limit
    double relativeError = 0.0; ///< 0: no target
    std::vector<std::string> channels;
    std::string reference;  ///< empty: none
    std::string statistics; ///< empty: none
    bool report = false;
    Context context = Context::None;
    bool listOptions = false;
    std::string writtenMaterials; ///< file for the models' materials; empty: none is written
    bool names = false; ///< true: the names of the models are printed, and nothing is rendered
    osg::ref_ptr<RayTraceSettings> settings; ///< maxPasses is the pass after the last one

    /// Holds the settings that the command line states: names and values.
    std::vector<std::pair<std::string, std::string>> assignments;
    std::optional<int> defaultPasses; ///< limit of passes unless somebody states one

    /// Returns the width by the height of the picture, of which a crop is a part.
    double aspect() const
    {
        return crop ? double(crop->fullWidth) / crop->fullHeight : double(width) / height;
    }

    /// Returns whether the view moves with the time.
    bool hasMovingView() const { return cameraPath || turnFrames != 0; }

    /// Returns whether the passes are part of a picture that is made elsewhere, or at other times.
    bool isPart() const { return !checkpoint.empty() || firstPass > 0 || mpi; }

    /// Returns how many passes the picture has if no other limit ends it.
    int mostPasses() const { return settings->getMaxPasses() - firstPass; }
};

/// Takes over the settings that a scene brings with it; settings that the command line states win.
/// A limit of passes that is RayTraceSettings' own default states nothing.
void takeStoredSettings(const RayTraceSettings& stored, Options& options);

/// Returns the options; nothing if the command line asked for help or the version, which was then
/// printed. Throws Failure(kUsage).
std::optional<Options> parseOptions(int argc, char** argv);

/// Returns every RayTraceSettings option as a Markdown table, as the documents show it.
std::string optionTable();

} // namespace osgRayTrace::app
