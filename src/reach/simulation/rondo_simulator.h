#ifndef RONDO_SIMULATOR_H
#define RONDO_SIMULATOR_H

/* What a shared library offers to `rondo reach --statistical --simulator ./robot.so`. C, so that any language
 * can. */

#include <stddef.h> /* NOLINT(modernize-deprecated-headers): for C, too */

#ifdef __cplusplus
extern "C" {
#endif

/* Simulates the robot from `start` and writes (steps + 1) * dimension numbers to `trace`: its state at 0, dt,
 * ..., steps * dt seconds, one after the other. `dimension` states, in the order of the robot's declaration.
 * Returns 0; anything else is a failure. Is called by one thread at a time. */
int rondo_simulate(const double* start, size_t dimension, double dt, size_t steps, double* trace);

#ifdef __cplusplus
}
#endif

#endif
