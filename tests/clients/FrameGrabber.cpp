// FrameGrabber.cpp - preloaded, this library makes a viewer of OSG repeatable, takes its pictures
// and closes it. Layer: tests.
// SPDX-License-Identifier: MIT
//
// Its definitions of functions of libosg and libosgViewer are found before theirs, which they call.
// OSGRAYTRACE_TEST_FRAMES is the frame whose pictures are taken; OSGRAYTRACE_TEST_PICTURES begins
// the names of the files: "<begin>0.png" for the first window, and "<begin>.txt" for the counts.
#include <osg/GraphicsThread>
#include <osg/Timer>
#include <osgDB/WriteFile>
#include <osgViewer/CompositeViewer>
#include <osgViewer/Viewer>

#include <dlfcn.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace
{

using Clock = std::chrono::steady_clock;

/// Time stands still in the last frames, so that a picture may converge.
constexpr int kStillFrames = 8;

/// Threads that draw may be that many frames behind.
constexpr int kFramesOfOtherThreads = 3;

constexpr osg::Timer_t kFrameTicks = 33333; ///< microseconds, the ticks of osg::Timer on Linux

/// The functions of this library are called by the threads of the program that update and draw.
struct Recording
{
    std::mutex mutex; ///< guards all but the numbers
    std::map<const void*, int> framesOfViewers;
    std::map<const osg::GraphicsContext*, int> windows; ///< their numbers
    Clock::time_point begin;                            ///< of the present frame
    std::vector<double> milliseconds; ///< of each frame of the second half of the frames
    std::vector<double> processor;    ///< processor time of all threads in these frames [ms]
    double processorBegin = 0.0;      ///< of the present frame [ms]
    std::atomic<int> frame{0};
    std::atomic<osg::Timer_t> calls{0};
};

Recording& recording()
{
    static auto* recording = new Recording; // outlives the program's threads
    return *recording;
}

std::string variable(const char* name, const char* otherwise)
{
    const char* value = std::getenv(name);
    return value ? value : otherwise;
}

int lastFrame()
{
    static const int frame =
        std::max(1, std::atoi(variable("OSGRAYTRACE_TEST_FRAMES", "30").c_str()));
    return frame;
}

std::string pictures()
{
    static const std::string begin = variable("OSGRAYTRACE_TEST_PICTURES", "picture");
    return begin;
}

template <typename Function> Function original(const char* symbol)
{
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, symbol));
}

/// Returns the processor time that all threads have taken [ms].
double processorMilliseconds()
{
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
    return values[values.size() / 2];
}

void writeCounts(const Recording& now, int frames)
{
    std::ofstream(pictures() + ".txt")
        << "frames " << frames << "\nmilliseconds " << median(now.milliseconds) << "\nprocessor "
        << median(now.processor) << "\nwindows " << now.windows.size() << '\n';
}

/// Records that a viewer begins a frame; returns whether it has drawn enough of them.
bool beginFrame(const void* viewer)
{
    Recording& now = recording();
    const std::lock_guard<std::mutex> lock(now.mutex);
    const int frame = ++now.framesOfViewers[viewer];
    const int half = lastFrame() / 2, end = lastFrame() + kFramesOfOtherThreads;
    if (frame <= now.frame) return now.frame >= end;
    now.frame = frame;
    const Clock::time_point last = now.begin;
    now.begin = Clock::now();
    const double lastProcessor = now.processorBegin;
    now.processorBegin = processorMilliseconds();
    if (frame > half + 1 && frame <= lastFrame() + 1)
    {
        now.milliseconds.push_back(
            std::chrono::duration<double, std::milli>(now.begin - last).count());
        now.processor.push_back(now.processorBegin - lastProcessor);
    }
    if (frame == end) writeCounts(now, lastFrame());
    return frame >= end;
}

/// Writes what a window is about to show, once.
void takePicture(osg::GraphicsContext& context)
{
    const osg::GraphicsContext::Traits* traits = context.getTraits();
    if (!traits || traits->pbuffer || recording().frame < lastFrame()) return;
    std::size_t number = 0;
    {
        const std::lock_guard<std::mutex> lock(recording().mutex);
        number = recording().windows.size();
        if (!recording().windows.emplace(&context, int(number)).second) return;
    }
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->readPixels(0, 0, traits->width, traits->height, GL_RGB, GL_UNSIGNED_BYTE);
    osgDB::writeImageFile(*image, pictures() + std::to_string(number) + ".png");
}

template <typename Viewer> void advanceOrEnd(Viewer& viewer, void (*advance)(Viewer*, double))
{
    if (beginFrame(&viewer)) viewer.setDone(true);
    advance(&viewer, USE_REFERENCE_TIME);
}

/// A program that ends by itself has drawn fewer frames.
struct EarlyEnd
{
    ~EarlyEnd()
    {
        const int frames = recording().frame;
        if (frames > 0 && frames < lastFrame() + kFramesOfOtherThreads)
            writeCounts(recording(), frames);
    }
} earlyEnd;

} // namespace

/// Advances by 1/30 s a frame, and by a microsecond a call for loops that wait.
__attribute__((visibility("default"))) osg::Timer_t osg::Timer::tick() const
{
    const int frame = std::min(recording().frame.load(), lastFrame() - kStillFrames);
    return osg::Timer_t(1000000000) + osg::Timer_t(std::max(0, frame)) * kFrameTicks +
           ++recording().calls;
}

__attribute__((visibility("default"))) void osgViewer::Viewer::advance(double)
{
    using Advance = void (*)(osgViewer::Viewer*, double);
    static const auto advance = original<Advance>("_ZN9osgViewer6Viewer7advanceEd");
    advanceOrEnd(*this, advance);
}

__attribute__((visibility("default"))) void osgViewer::CompositeViewer::advance(double)
{
    using Advance = void (*)(osgViewer::CompositeViewer*, double);
    static const auto advance = original<Advance>("_ZN9osgViewer15CompositeViewer7advanceEd");
    advanceOrEnd(*this, advance);
}

/// Opens DISPLAY whatever the program asks for: several of OSG's examples want :0.0.
extern "C" __attribute__((visibility("default"))) void* XOpenDisplay(const char*)
{
    using Open = void* (*)(const char*);
    static const auto open = original<Open>("XOpenDisplay");
    return open(nullptr);
}

/// Contexts without a thread of their own swap by this function.
__attribute__((visibility("default"))) void osg::GraphicsContext::swapBuffers()
{
    using Swap = void (*)(osg::GraphicsContext*);
    static const auto swap = original<Swap>("_ZN3osg15GraphicsContext11swapBuffersEv");
    takePicture(*this);
    swap(this);
}

/// Contexts with a thread of their own swap by this function.
__attribute__((visibility("default"))) void
osg::SwapBuffersOperation::operator()(osg::GraphicsContext* context)
{
    using Swap = void (*)(osg::SwapBuffersOperation*, osg::GraphicsContext*);
    static const auto swap =
        original<Swap>("_ZN3osg20SwapBuffersOperationclEPNS_15GraphicsContextE");
    takePicture(*context);
    swap(this, context);
}
