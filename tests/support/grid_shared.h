/* One grid for all tests of a program, with cmocka's set-up and tear-down. */
#ifndef RLF_TEST_GRID_SHARED_H
#define RLF_TEST_GRID_SHARED_H

#include "grid_fixture.h"

static grid_fixture *fixture;

static int set_up(void **state)
{
    (void)state;
    fixture = grid_fixture_create();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    grid_fixture_destroy(&fixture);
    return 0;
}

#endif
