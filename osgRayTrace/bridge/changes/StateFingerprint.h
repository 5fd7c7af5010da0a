// StateFingerprint.h - the values of state sets and lights, as far as they are traced. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/Digest.h"

#include <osg/Light>
#include <osg/StateSet>
#include <osg/TexGen>
#include <osg/Texture>

namespace osgRayTrace::engine
{

/// Modes, and attributes with their values and the modified counts of their images; but not what
/// belongs to the frame, as the viewport does.
void addStateSet(Digest& digest, const osg::StateSet& stateSet);

void addLight(Digest& digest, const osg::Light& light);

/// Its modified count and its data; null: none.
void addImage(Digest& digest, const osg::Image* image);

/// Its settings, and its images with their modified counts and data.
void addTexture(Digest& digest, const osg::Texture& texture);

void addTexGen(Digest& digest, const osg::TexGen& texGen);

} // namespace osgRayTrace::engine
