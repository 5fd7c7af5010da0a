// main.cpp - osgraytrace-server: traces tiles for viewers on other machines. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/ErrorLine.h"
#include "apps/osgraytrace-server/ZmqPort.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/servers/BuildIdentity.h"
#include "osgRayTrace/servers/TileServer.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <exception>
#include <iostream>
#include <string>

namespace osgRayTrace::app
{

namespace
{

constexpr const char* kProgram = "osgraytrace-server";

volatile std::sig_atomic_t receivedSignal = 0;

void recordSignal(int number)
{
    receivedSignal = number;
}

struct Options
{
    std::string listen = "tcp://127.0.0.1:7411";
    int threads = 0;
    std::string secretKey;
    std::string newKeys;
};

bool isLoopback(const std::string& address)
{
    for (const char* start : {"tcp://127.", "tcp://localhost:", "tcp://[::1]:"})
        if (address.rfind(start, 0) == 0) return true;
    return false;
}

/// Serves viewers until a signal comes. Returns the exit code of shells for it.
int serve(const Options& options)
{
    constexpr int kPatience = 100; // [ms]
    ZmqPort port(options.listen, options.secretKey);
    const auto workers = std::make_shared<engine::Workers>(options.threads);
    std::cout << kProgram << ": " << engine::buildIdentity() << ", " << workers->threads()
              << " threads, at " << port.address() << std::endl;
    if (!isLoopback(port.address()) && options.secretKey.empty())
        printError(kProgram,
                   "whoever reaches this port may use this machine's processors and memory "
                   "(--secret-key)");
    engine::TileServer server(workers, [&](const std::string& viewer, engine::Bytes&& message)
                              { port.send(viewer, std::move(message)); });
    std::string viewer;
    engine::Bytes message;
    while (!receivedSignal)
    {
        while (!receivedSignal && port.receive(viewer, message))
            server.take(viewer, message);
        const bool first = server.tilesTraced() == 0;
        if (!receivedSignal && !server.work()) port.wait(kPatience);
        if (first && server.tilesTraced() > 0)
            std::cout << kProgram << ": traces for the first viewer" << std::endl;
    }
    std::cout << kProgram << ": ended by signal " << receivedSignal << ", traced "
              << server.tilesTraced() << " tiles" << std::endl;
    return 0;
}

int run(int argc, char** argv)
{
    constexpr int kMostThreads = 1024;
    Options options;
    CLI::App app("Traces tiles of the images of viewers whose setting servers names this machine.",
                 kProgram);
    app.set_version_flag("--version", engine::buildIdentity());
    app.add_option("--listen", options.listen,
                   "Address and port; other machines reach tcp://*:7411")
        ->capture_default_str();
    app.add_option("--threads", options.threads, "Threads; 0: all of the machine")
        ->check(CLI::Range(0, kMostThreads))
        ->capture_default_str();
    app.add_option("--secret-key", options.secretKey,
                   "File with the secret key: only viewers that have the public one connect");
    app.add_option("--make-keys", options.newKeys,
                   "Write a pair of keys to PREFIX.secret and PREFIX.public, and end")
        ->type_name("PREFIX");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? 0 : 1;
    }
    if (!options.newKeys.empty())
    {
        ZmqPort::makeKeys(options.newKeys);
        return 0;
    }
    struct sigaction action = {};
    action.sa_handler = recordSignal;
    for (const int number : {SIGINT, SIGTERM, SIGHUP})
        sigaction(number, &action, nullptr);
    return serve(options);
}

} // namespace

} // namespace osgRayTrace::app

int main(int argc, char** argv)
{
    try
    {
        return osgRayTrace::app::run(argc, argv);
    }
    catch (const std::exception& error)
    {
        osgRayTrace::app::printError("osgraytrace-server", error.what());
        return 1;
    }
}
