/* The subcommands of `relief-lab`; argv[0] is the subcommand's name. Each returns an exit status.
 */
#ifndef RELIEF_LAB_LAB_COMMANDS_H
#define RELIEF_LAB_LAB_COMMANDS_H

int eval_main(int argc, char **argv);
int bench_main(int argc, char **argv);

#endif
