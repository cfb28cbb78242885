/* Ours and theirs in one table per stage. */
#ifndef RELIEF_APP_BENCH_PEERS_TABLE_H
#define RELIEF_APP_BENCH_PEERS_TABLE_H

#include "bench/bench.h"
#include "bench/peers_results.h"

/* Prints the stages by their least times and adds a row of each; the first entries are ours, one
 * per group. Sorts them. */
void peer_table_print(peer_results *r, bench_table *table);
/* The same as an array of groups: title, heads of the quality figures, rows of times and figures.
 */
json_t *peer_table_json(const peer_results *r);

#endif
