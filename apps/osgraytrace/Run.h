// Run.h - from models to files: one picture, or the frames of an animation. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Picture.h"

#include "apps/common/ErrorMeasures.h"

#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

constexpr const char* kProgram = "osgraytrace";

class Group;

/// Renders the picture that the options ask for, and writes it; in the group, if there is one,
/// whose rank 0 this is. Returns the exit code; throws Failure.
int runPicture(Options options, Group* group = nullptr);

/// Renders the picture together with the other processes that mpirun has started; rank 0 writes it.
/// Returns the exit code; throws Failure.
int runInGroup(const Options& options);

/// Renders the frames that the options ask for one after the other, and writes them. Each looks as
/// if it were the only one. Throws Failure; the frames before it are written then.
int runFrames(const Options& options);

/// Joins the checkpoints that the options name, and writes the picture. Returns the exit code;
/// throws Failure.
int runMerge(const Options& options);

/// Throws the failures of files that the options ask for, as far as they are known before the work.
void checkFiles(const Options& options);

/// Throws Failure(kCannotLoad) if the file of --materials is wrong.
void checkMaterials(const Options& options);

/// Returns the scene below a group that also has the lights, or the scene itself if there are none.
/// Throws Failure(kCannotLoad).
osg::ref_ptr<osg::Node> lit(const osg::ref_ptr<osg::Node>& scene, const SceneLights& lights);

/// Takes the settings of the scene; those of the command line win. Throws Failure(kCannotLoad).
void takeSettingsOf(osg::Node& scene, Options& options);

/// Renders the scene at the options' time. Throws Failure.
Picture render(const Options& options, TimedScene& shown, Group* group = nullptr);

/// Writes a picture and its statistics; all that can be written, whatever else fails. Returns the
/// exit code.
int writeAll(const Options& options, const std::vector<std::string>& outputs,
             const Picture& picture, const std::optional<ErrorMeasures>& measures);

} // namespace osgRayTrace::app
