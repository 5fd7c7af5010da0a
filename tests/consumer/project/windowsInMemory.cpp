// windowsInMemory.cpp - preloaded, this library opens windows of osgViewer in memory, for a
// scripted user.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osgDB/WriteFile>
#include <osgViewer/GraphicsWindow>

#include <cstdlib>
#include <sstream>
#include <string>

namespace
{

/// The script is the variable OSGRAYTRACE_TEST_SCRIPT: words, each command with the number of the
/// frame before which it is executed: "5 key m 9 click 160 120 12 picture FILE 20 close". A click
/// is given in pixels from the upper left corner, and a picture is that of the frame.
class WindowInMemory : public osgViewer::GraphicsWindow
{
public:
    explicit WindowInMemory(Traits* traits)
        : _context(osgRayTrace::createOSMesaContext(traits->width, traits->height))
    {
        const char* script = std::getenv("OSGRAYTRACE_TEST_SCRIPT");
        _script.str(script ? script : "0 close");
        _script >> _nextFrame;
        _traits = traits;
        _traits->doubleBuffer = false;
        setState(new osg::State);
        getState()->setGraphicsContext(this);
        getState()->setContextID(createNewContextID());
        getEventQueue()->syncWindowRectangleWithGraphicsContext();
    }

    bool valid() const override { return _context && _context->valid(); }
    bool realizeImplementation() override { return _context->realizeImplementation(); }
    bool isRealizedImplementation() const override { return _context->isRealizedImplementation(); }
    void closeImplementation() override { _context->closeImplementation(); }
    bool makeCurrentImplementation() override { return _context->makeCurrentImplementation(); }
    bool releaseContextImplementation() override
    {
        return _context->releaseContextImplementation();
    }

    /// osgViewer calls this function once a frame.
    bool checkEvents() override
    {
        for (; _script && _nextFrame <= _frame; _script >> _nextFrame)
            execute();
        ++_frame;
        return GraphicsWindow::checkEvents();
    }

    void swapBuffersImplementation() override
    {
        _context->swapBuffersImplementation();
        if (_picture.empty()) return;
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->readPixels(0, 0, _traits->width, _traits->height, GL_RGB, GL_UNSIGNED_BYTE);
        osgDB::writeImageFile(*image, _picture);
        _picture.clear();
    }

private:
    ~WindowInMemory() override { close(); }

    void execute()
    {
        std::string command;
        _script >> command;
        osgGA::EventQueue& events = *getEventQueue();
        if (command == "key")
        {
            char key = 0;
            _script >> key;
            events.keyPress(key);
            events.keyRelease(key);
        }
        else if (command == "click")
        {
            float x = 0.0f, y = 0.0f;
            _script >> x >> y;
            events.mouseButtonPress(x, y, 1);
            events.mouseButtonRelease(x, y, 1);
        }
        else if (command == "picture")
            _script >> _picture;
        else if (command == "close")
            events.closeWindow();
        else
        {
            OSG_FATAL << "Unknown command of the script: '" << command << "'" << std::endl;
            std::abort();
        }
    }

    osg::ref_ptr<osg::GraphicsContext> _context;
    std::istringstream _script;
    int _frame = 0, _nextFrame = 0;
    std::string _picture; ///< file that is written after the frame; empty: none
};

struct WindowingSystem : osg::GraphicsContext::WindowingSystemInterface
{
    using Screen = osg::GraphicsContext::ScreenIdentifier;
    using Settings = osg::GraphicsContext::ScreenSettings;

    unsigned int getNumScreens(const Screen&) override { return 1; }
    void getScreenSettings(const Screen&, Settings& settings) override { settings = {1280, 1024}; }
    void enumerateScreenSettings(const Screen&,
                                 osg::GraphicsContext::ScreenSettingsList& list) override
    {
        list.assign(1, {1280, 1024});
    }
    osg::GraphicsContext* createGraphicsContext(osg::GraphicsContext::Traits* traits) override
    {
        osg::ref_ptr<WindowInMemory> window = new WindowInMemory(traits);
        return window->valid() ? window.release() : nullptr;
    }
};

/// The first windowing system is the one that a program uses if it names none.
const bool registered = []
{
    auto& systems = osg::GraphicsContext::getWindowingSystemInterfaces()->getInterfaces();
    systems.insert(systems.begin(), new WindowingSystem);
    return true;
}();

} // namespace
