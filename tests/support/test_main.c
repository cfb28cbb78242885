/* A program that is nothing but its tests. */
#include "test.h"

int main(void)
{
    return test_run_all();
}
