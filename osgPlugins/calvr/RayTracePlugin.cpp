// RayTracePlugin.cpp - the functions that CalVR calls, and their order. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "RayTracePlugin.h"

#include <osgRayTrace/Statistics>

#include <cvrConfig/ConfigManager.h>
#include <cvrInput/TrackingManager.h>
#include <cvrKernel/PluginHelper.h>

#include <osg/Notify>

#include <cstdio>
#include <exception>

CVRPLUGIN(osgRayTrace::calvr::RayTracePlugin)

namespace osgRayTrace::calvr
{

namespace
{

const std::string kElement = "Plugin.RayTrace";

void warn(const std::string& sentence)
{
    OSG_WARN << "RayTrace: " << sentence << std::endl;
}

/// Calls a function; an exception ends that function alone, with a warning.
template <typename Function> void guarded(const char* what, Function function) noexcept
{
    try
    {
        function();
    }
    catch (const std::exception& error)
    {
        OSG_WARN << "RayTrace: " << what << ": " << error.what() << std::endl;
    }
    catch (...)
    {
        OSG_WARN << "RayTrace: " << what << " failed" << std::endl;
    }
}

} // namespace

RayTracePlugin::~RayTracePlugin()
{
    guarded("end", [this] { _root.reset(); });
    guarded("end of the menu", [this] { _menu.reset(); });
}

bool RayTracePlugin::init()
{
    guarded("configuration", [this] { readSettings(); });
    const bool cluster = !_connections.isMaster() || _connections.slaveCount() > 0;
    if (cluster) guarded("cluster", [this] { shareSettings(); });
    guarded("start", [this] { start(); });
    return true;
}

void RayTracePlugin::readSettings()
{
    _settings = wallSettings();
    std::vector<std::string> names;
    cvr::ConfigManager::getChildren(kElement, names);
    const auto valueOf = [](const std::string& name)
    { return cvr::ConfigManager::getEntry(kElement + "." + name); };
    _config = readConfig(names, valueOf, *_settings);
    for (const std::string& complaint : _config.complaints)
        warn("configuration: " + complaint);
}

/// Gives the master's settings to all nodes: environments and LOCAL blocks may differ.
void RayTracePlugin::shareSettings()
{
    _agreement.emplace(_connections); // this node goes on making the calls, whatever else fails
    if (_settings)
    {
        // The slaves' own wishes do not count either way.
        const std::string overruled = makeEqualOnAllNodes(*_settings, _config);
        if (_connections.isMaster() && !overruled.empty()) warn(overruled);
    }
    const std::string lines =
        mastersText(_connections, _settings ? sharedSettings(*_settings, _config) : "");
    if (!_settings) return;
    for (const std::string& complaint : takeSharedSettings(lines, *_settings, _config))
        warn(complaint);
}

void RayTracePlugin::start()
{
    if (!_settings) return;
    _root = std::make_unique<TracedRoot>(_settings.get());
    const bool frozen = !cvr::TrackingManager::instance()->getUpdateHeadTracking();
    _menu = std::make_unique<RayTraceMenu>(*this, _settings, _config.trace, frozen);
}

/// Prepares the frame without a look at the scene: update callbacks are still to come, and cull
/// converts.
void RayTracePlugin::preFrame()
{
    guarded("frame", [this] { switchAndLight(); });
    guarded("menu", [this] { showFreeze(); });
    std::optional<FrameWork> offered;
    guarded("statistics", [this, &offered] { offered = offer(); });
    if (_agreement) agree(offered);
}

/// Agrees on the work outside of guarded(): no node may leave out the calls over the network.
void RayTracePlugin::agree(const std::optional<FrameWork>& offer)
{
    const FrameWork agreed = _agreement->agree(offer);
    guarded("passes",
            [this, &agreed]
            {
                if (_root) _root->scene().getDrawable()->setFrameWork(agreed);
            });
    if (_toldVersion || !_agreement->hasMetOtherVersion()) return;
    _toldVersion = true;
    warn("the nodes have different versions of the plugin: their walls may not match");
}

void RayTracePlugin::switchAndLight()
{
    if (!_root || !_menu) return;
    if (_menu->isOn())
        _root->switchOn(cvr::PluginHelper::getObjectsRoot());
    else
        _root->switchOff();
    _root->updateLights(*cvr::PluginHelper::getScene(),
                        cvr::PluginHelper::getWorldToObjectTransform());
}

/// Shows whether the head is frozen, which CalVR or another plugin may also change.
void RayTracePlugin::showFreeze()
{
    if (_menu) _menu->showFrozen(!cvr::TrackingManager::instance()->getUpdateHeadTracking());
}

std::optional<FrameWork> RayTracePlugin::offer() const
{
    if (!_agreement || !_root || !_root->isOn()) return std::nullopt;
    if (!_root->scene().getDrawable()->getStatistics().ok) return std::nullopt;
    return _root->scene().getDrawable()->getAffordableWork();
}

void RayTracePlugin::menuCallback(cvr::MenuItem* item)
{
    guarded("menu",
            [this, item]
            {
                if (!_root || !_menu) return;
                _menu->clicked(item);
                if (_menu->isFreeze(item))
                    cvr::TrackingManager::instance()->setUpdateHeadTracking(!_menu->isFrozen());
                if (!_menu->isReport(item)) return;
                OSG_NOTICE << _root->scene().getConversionReport() << std::flush;
                std::fflush(stdout); // OSG writes to stdout, which may be a file
            });
}

} // namespace osgRayTrace::calvr
