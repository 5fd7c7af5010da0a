// StateHash.h - hashes the values of state sets and lights, as far as they are traced. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/Hasher.h"
#include "osgRayTrace/bridge/common/ShaderState.h"

#include <osgRayTrace/Medium>

#include <osg/Light>
#include <osg/StateSet>
#include <osg/TexGen>
#include <osg/Texture>

namespace osgRayTrace::engine
{

/// Adds modes, and attributes with their values and the modified counts of their images. Attributes
/// that belong to the frame, such as the viewport, are left out. reads: adds which uniforms and
/// user values there are, and the values of those that rules read; null: none. looks: adds the
/// values of osg::Material and osg::Fog, too, which do not decide on who draws a surface.
void addStateSet(Hasher& hasher, const osg::StateSet& stateSet, const ShaderReads* reads,
                 bool looks = true);

void addLight(Hasher& hasher, const osg::Light& light);

/// Adds the values of a medium; null stands for no medium.
void addMedium(Hasher& hasher, const osgRayTrace::Medium* medium);

/// Adds an image's modified count and its data; null stands for no image.
void addImage(Hasher& hasher, const osg::Image* image);

/// Adds a texture's settings, and its images with their modified counts and data.
void addTexture(Hasher& hasher, const osg::Texture& texture);

void addTexGen(Hasher& hasher, const osg::TexGen& texGen);

} // namespace osgRayTrace::engine
