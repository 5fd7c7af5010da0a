// StateGenerator.h - state sets, textures and lights with values that nobody would set. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "FuzzSeeds.h"

#include <osg/Image>
#include <osg/Light>
#include <osg/StateSet>

namespace osgRayTrace::test
{

osg::ref_ptr<osg::StateSet> randomStateSet(Dice& dice);

/// Returns an image of any format, even of formats that do not exist, sometimes without any pixels.
osg::ref_ptr<osg::Image> randomImage(Dice& dice);

osg::ref_ptr<osg::Light> randomLight(Dice& dice);

/// Returns what Dice::strange does, with infinity for values that are larger than any float.
float strangeFloat(Dice& dice, double size, int rarity);

} // namespace osgRayTrace::test
