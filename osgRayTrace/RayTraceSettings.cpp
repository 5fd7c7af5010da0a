// RayTraceSettings.cpp - setters that keep to ranges. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTraceSettings>

#include "osgRayTrace/OptionTable.h"
#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <cstdlib>

namespace osgRayTrace
{

using engine::warnOnce;

namespace
{

template <typename T> void change(T& member, T value, unsigned int& modifiedCount)
{
    if (member == value) return;
    member = value;
    ++modifiedCount;
}

/// Sets a member. A value out of range becomes the nearest one within; NaN leaves the member as it
/// is.
template <typename T>
void changeNumber(const char* name, const Range<T>& range, T& member, T value,
                  unsigned int& modifiedCount)
{
    if (!range.contains(value))
    {
        warnOnce(std::string(name) + " " + engine::numberText(value) + " is not in " +
                 engine::numberText(range.minimum) + " .. " + engine::numberText(range.maximum));
        if (value != value) return; // NOLINT(misc-redundant-expression): not a number
    }
    change(member, std::clamp(value, range.minimum, range.maximum), modifiedCount);
}

/// Sets a member, unless the value is no enumerator.
template <typename T>
void changeChoice(const char* name, Words words, T& member, T value, unsigned int& modifiedCount)
{
    const long long index = static_cast<long long>(value);
    if (index < 0 || index >= static_cast<long long>(words.size()))
    {
        warnOnce(std::string(name) + ": there is no value number " + engine::numberText(index));
        return;
    }
    change(member, value, modifiedCount);
}

void warnOfFormerName(const std::string& former, const std::string& name)
{
    warnOnce(former + " is called " + name + " now; the former name is still read");
}

/// Returns the text of the environment variable of an option or of its former name; null if neither
/// is set.
const char* environmentText(const RayTraceSettings::Option& option)
{
    const char* text = std::getenv(option.environment.c_str());
    if (text || option.formerName.empty()) return text;
    const std::string former = environmentName(option.formerName);
    text = std::getenv(former.c_str());
    if (text) warnOfFormerName(former, option.environment);
    return text;
}

} // namespace

RayTraceSettings::RayTraceSettings()
{
    for (const OptionRow& row : optionTable())
    {
        const char* text = environmentText(row.option);
        if (!text || row.set(*this, text)) continue;
        warnOnce("environment variable " + row.option.environment + ": '" + text +
                 "' is not one of " + row.option.range + "; ignored");
    }
    _modifiedCount = 0;
}

struct RayTraceSettings::WithoutEnvironment
{
};

RayTraceSettings::RayTraceSettings(WithoutEnvironment) {}

RayTraceSettings::RayTraceSettings(const RayTraceSettings& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), _values(other._values), _materialHook(other._materialHook)
{
}

RayTraceSettings::~RayTraceSettings() = default;

void RayTraceSettings::setIntegrator(Integrator value)
{
    changeChoice("integrator", kIntegratorWords, _values.integrator, value, _modifiedCount);
}

void RayTraceSettings::setLightSampling(LightSampling value)
{
    changeChoice("light-sampling", kLightSamplingWords, _values.lightSampling, value,
                 _modifiedCount);
}

void RayTraceSettings::setEnvironmentSampling(EnvironmentSampling value)
{
    changeChoice("environment-sampling", kEnvironmentSamplingWords, _values.environmentSampling,
                 value, _modifiedCount);
}

void RayTraceSettings::setEnvironmentSamples(int value)
{
    changeNumber("environment-samples", kEnvironmentSamplesRange, _values.environmentSamples, value,
                 _modifiedCount);
}

void RayTraceSettings::setDebugChannel(DebugChannel value)
{
    changeChoice("debug-channel", kDebugChannelWords, _values.debugChannel, value, _modifiedCount);
}

void RayTraceSettings::setColorRule(ColorRule value)
{
    changeChoice("color-rule", kColorRuleWords, _values.colorRule, value, _modifiedCount);
}

void RayTraceSettings::setLightSamples(int value)
{
    changeNumber("light-samples", kLightSamplesRange, _values.lightSamples, value, _modifiedCount);
}

void RayTraceSettings::setLightRadius(float value)
{
    changeNumber("light-radius", kLightRadiusRange, _values.lightRadius, value, _modifiedCount);
}

void RayTraceSettings::setLightAngle(float value)
{
    changeNumber("light-angle", kLightAngleRange, _values.lightAngle, value, _modifiedCount);
}

void RayTraceSettings::setLightSizes(const std::string& value)
{
    if (!areLightSizes(value))
        warnOnce("light-sizes '" + value + "' are not NAME=SIZE,...; ignored");
    else
        change(_values.lightSizes, value.empty() ? std::string("none") : value, _modifiedCount);
}

void RayTraceSettings::setCullAllRays(bool value)
{
    change(_values.cullAllRays, value, _modifiedCount);
}

void RayTraceSettings::setGround(const std::string& value)
{
    if (!isGround(value))
        warnOnce("ground '" + value + "' is not none, auto or a height; ignored");
    else
        change(_values.ground, value.empty() ? std::string("none") : value, _modifiedCount);
}

void RayTraceSettings::setFog(Fog value)
{
    changeChoice("fog", kFogWords, _values.fog, value, _modifiedCount);
}

void RayTraceSettings::setPointRadius(float value)
{
    changeNumber("point-radius", kPointRadiusRange, _values.pointRadius, value, _modifiedCount);
}

void RayTraceSettings::setMaxBounces(int value)
{
    changeNumber("max-bounces", kMaxBouncesRange, _values.maxBounces, value, _modifiedCount);
}

void RayTraceSettings::setShadows(bool value)
{
    change(_values.shadows, value, _modifiedCount);
}

void RayTraceSettings::setHeadlightShadows(bool value)
{
    change(_values.headlightShadows, value, _modifiedCount);
}

void RayTraceSettings::setTerminatorCorrection(bool value)
{
    change(_values.terminatorCorrection, value, _modifiedCount);
}

void RayTraceSettings::setPresentation(Presentation value)
{
    changeChoice("presentation", kPresentationWords, _values.presentation, value, _modifiedCount);
}

void RayTraceSettings::setReproject(bool value)
{
    change(_values.reproject, value, _modifiedCount);
}

void RayTraceSettings::setKeepUnchanged(bool value)
{
    change(_values.keepUnchanged, value, _modifiedCount);
}

void RayTraceSettings::setPhotonGuiding(bool value)
{
    change(_values.photonGuiding, value, _modifiedCount);
}

void RayTraceSettings::setDenoise(Denoise value)
{
    changeChoice("denoise", kDenoiseWords, _values.denoise, value, _modifiedCount);
}

void RayTraceSettings::setMaxPasses(int value)
{
    changeNumber("max-passes", kMaxPassesRange, _values.maxPasses, value, _modifiedCount);
}

void RayTraceSettings::setFrameBudget(float value)
{
    changeNumber("frame-budget", kFrameBudgetRange, _values.frameBudget, value, _modifiedCount);
}

void RayTraceSettings::setDegradeWhileMoving(bool value)
{
    change(_values.degradeWhileMoving, value, _modifiedCount);
}

void RayTraceSettings::setEqualViews(bool value)
{
    change(_values.equalViews, value, _modifiedCount);
}

void RayTraceSettings::setPassesPerFrame(int value)
{
    changeNumber("passes-per-frame", kPassesPerFrameRange, _values.passesPerFrame, value,
                 _modifiedCount);
}

void RayTraceSettings::setThreads(int value)
{
    changeNumber("threads", kThreadsRange, _values.threads, value, _modifiedCount);
}

void RayTraceSettings::setSeed(unsigned int value)
{
    change(_values.seed, value, _modifiedCount);
}

void RayTraceSettings::setAperture(float value)
{
    changeNumber("aperture", kApertureRange, _values.aperture, value, _modifiedCount);
}

void RayTraceSettings::setFocus(float value)
{
    changeNumber("focus", kFocusRange, _values.focus, value, _modifiedCount);
}

void RayTraceSettings::setExposure(float value)
{
    changeNumber("exposure", kExposureRange, _values.exposure, value, _modifiedCount);
}

void RayTraceSettings::setAutoExposure(bool value)
{
    change(_values.autoExposure, value, _modifiedCount);
}

void RayTraceSettings::setToneCurve(ToneCurve value)
{
    changeChoice("tone-curve", kToneCurveWords, _values.toneCurve, value, _modifiedCount);
}

void RayTraceSettings::setPhotons(int value)
{
    changeNumber("photons", kPhotonsRange, _values.photons, value, _modifiedCount);
}

void RayTraceSettings::setPhotonRadius(float value)
{
    changeNumber("photon-radius", kPhotonRadiusRange, _values.photonRadius, value, _modifiedCount);
}

void RayTraceSettings::setPhotonBeams(int value)
{
    changeNumber("photon-beams", kPhotonBeamsRange, _values.photonBeams, value, _modifiedCount);
}

void RayTraceSettings::setPhotonAlpha(float value)
{
    changeNumber("photon-alpha", kPhotonAlphaRange, _values.photonAlpha, value, _modifiedCount);
}

void RayTraceSettings::setRadiusSchedule(RadiusSchedule value)
{
    changeChoice("radius-schedule", kRadiusScheduleWords, _values.radiusSchedule, value,
                 _modifiedCount);
}

void RayTraceSettings::setMaterials(const std::string& value)
{
    change(_values.materials, value.empty() ? std::string("none") : value, _modifiedCount);
}

void RayTraceSettings::setServers(const std::string& value)
{
    if (!areServers(value))
        warnOnce("servers '" + value + "' are not tcp://HOST:PORT,...; ignored");
    else
        change(_values.servers, value.empty() ? std::string("none") : value, _modifiedCount);
}

void RayTraceSettings::setMaterialHook(MaterialHook* hook)
{
    change(_materialHook, osg::ref_ptr<MaterialHook>(hook), _modifiedCount);
}

std::string RayTraceSettings::getMaterialsError() const
{
    return _values.materials == "none" ? std::string()
                                       : engine::readMaterialLibrary(_values.materials).error;
}

std::vector<RayTraceSettings::Option> RayTraceSettings::options()
{
    const osg::ref_ptr<RayTraceSettings> defaults = new RayTraceSettings(WithoutEnvironment());
    std::vector<Option> list;
    for (const OptionRow& row : optionTable())
    {
        list.push_back(row.option);
        list.back().defaultValue = row.get(*defaults);
    }
    return list;
}

bool RayTraceSettings::set(const std::string& name, const std::string& value)
{
    const OptionRow* row = findRow(name);
    if (row && isFormerName(*row, name)) warnOfFormerName(row->option.formerName, row->option.name);
    return row && row->set(*this, value);
}

std::string RayTraceSettings::get(const std::string& name) const
{
    const OptionRow* row = findRow(name);
    return row ? row->get(*this) : std::string();
}

} // namespace osgRayTrace
