// Messages.h - records what is written to the host's log, for tests of warnings.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Notify>
#include <osg/ref_ptr>

#include <string>

namespace osgRayTrace::engine::test
{

/// Records what OSG is told to log while an object of this class lives.
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
