// Pictured.h - a scene graph as a picture, and what was said about it. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/bridge/Graphs.h"
#include "tests/stability/geometry/Compare.h"

#include <osg/LightSource>
#include <osg/Notify>

#include <initializer_list>
#include <string>

namespace osgRayTrace::engine::test
{

/// The nodes below a point light at (1, -3, 4).
inline osg::ref_ptr<osg::Group> lit(std::initializer_list<osg::ref_ptr<osg::Node>> nodes)
{
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->getLight()->setPosition({1.0f, -3.0f, 4.0f, 1.0f});
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(source);
    root->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    for (const osg::ref_ptr<osg::Node>& node : nodes)
        root->addChild(node);
    return root;
}

inline View obliqueView(int pixels = 96)
{
    return perspectiveView({1.5, -2.5, 2.0}, {0, 0, 0}, {0, 0, 1}, 35.0, pixels, pixels);
}

inline Picture pictureOf(const ConversionResult& converted, IntegratorKind kind)
{
    const auto traced = TracedScene::build(converted.scene, std::make_shared<Workers>());
    return render(traced, obliqueView(), optionsOf(kind), 16);
}

/// What OSG is told while this lives.
class Messages
{
public:
    Messages() : _before(osg::getNotifyHandler()), _level(osg::getNotifyLevel())
    {
        osg::setNotifyLevel(osg::WARN);
        osg::setNotifyHandler(_handler);
    }
    ~Messages()
    {
        osg::setNotifyHandler(_before);
        osg::setNotifyLevel(_level);
    }
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    const std::string& text() const { return _handler->text; }

    int timesSaid(const std::string& words) const
    {
        int times = 0;
        for (std::size_t at = text().find(words); at != std::string::npos;
             at = text().find(words, at + words.size()))
            ++times;
        return times;
    }

private:
    struct Handler : osg::NotifyHandler
    {
        void notify(osg::NotifySeverity, const char* message) override { text += message; }
        std::string text;
    };

    osg::ref_ptr<Handler> _handler = new Handler;
    osg::ref_ptr<osg::NotifyHandler> _before;
    osg::NotifySeverity _level;
};

} // namespace osgRayTrace::engine::test
