// Video.h - a video that ffmpeg makes of frames, where it is installed. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Returns whether a file of this name is a video: .mp4, .mov, .mkv, .webm.
bool isVideo(const std::string& path);

/// Returns why no video can be made; empty if ffmpeg is there.
std::string whyNoVideo();

/// Sends frames to an ffmpeg of its own, which writes them to a file.
class Video
{
public:
    /// Starts ffmpeg. name tells the format by its extension, file is where the video goes. Throws
    /// std::runtime_error.
    Video(const std::string& name, const std::string& file, double framesPerSecond);

    /// Ends ffmpeg; the file is then of no use unless finish() came before.
    ~Video();
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;

    /// Adds a frame of GL_RGBA and GL_UNSIGNED_BYTE, row 0 at the bottom; all have one size. Throws
    /// std::runtime_error.
    void add(const osg::Image& frame);

    /// Completes the file. Throws std::runtime_error if it has no frame, or if ffmpeg failed.
    void finish();

private:
    void start(int width, int height);
    void endInput();

    std::string _name, _file;
    double _framesPerSecond;
    int _pipe = -1;    ///< ffmpeg's standard input; -1: closed
    int _process = -1; ///< -1: not started, or ended
    std::vector<unsigned char> _rgb;
};

} // namespace osgRayTrace::app
