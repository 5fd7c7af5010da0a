// SettingSteps.h - the next and the last value of a setting. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>

#include <string>

namespace osgRayTrace::app
{

/// Sets a setting to its next value, or to the one before. Words go around; limits of passes and
/// samples are doubled and halved, other whole numbers change by 1 and the exposure by half a
/// stop, within their ranges. A ground is right below the model, or not there.
void stepSetting(RayTraceSettings& settings, const std::string& name, bool up);

} // namespace osgRayTrace::app
