// TileTracer.h - traces tiles of passes of others' images. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/TileHelp.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

class Integrator;
class Workers;
struct PassContext;
struct SessionState;

/// Traces tiles as the session does whose pass it is, without an image of its own. One thread at a
/// time may use a tracer.
class TileTracer
{
public:
    explicit TileTracer(std::shared_ptr<Workers> workers);
    ~TileTracer();
    TileTracer(const TileTracer&) = delete;
    TileTracer& operator=(const TileTracer&) = delete;

    /// Prepares a pass. Returns false if its view cannot be traced. Throws what a render throws.
    bool begin(const HelpedPass& pass);

    /// Returns how many tiles the view of the prepared pass has.
    int tileCount() const;

    /// Traces tiles of the prepared pass on the workers, and moves what they begin with into the
    /// results, which have as many elements. photons: of each tile if the pass has photons.
    void trace(const std::vector<int>& tiles, std::vector<TilePhotons>&& photons,
               std::vector<TracedTile>& results);

    /// Lets go of the scene.
    void clear();

private:
    std::shared_ptr<Workers> _workers;
    std::unique_ptr<SessionState> _state;
    std::unique_ptr<PassContext> _context;
    std::unique_ptr<Integrator> _integrator;
    HelpedPass _pass;
    PixelProjection _projection; ///< for photons
};

} // namespace osgRayTrace::engine
