/* The subcommands of `relief`. */
#ifndef RELIEF_APP_COMMANDS_H
#define RELIEF_APP_COMMANDS_H

/* One per subcommand; argv[0] is the subcommand's name. */
int run_main(int argc, char **argv);
/* As `relief run` without a SOURCE; -1 where there is no window to choose one in. */
int run_alone(void);
int record_main(int argc, char **argv);
int place_main(int argc, char **argv);
int export_main(int argc, char **argv);
int fuse_main(int argc, char **argv);
int info_main(int argc, char **argv);
int sources_main(int argc, char **argv);
int scenes_main(int argc, char **argv);
int calibrate_main(int argc, char **argv);
int settings_main(int argc, char **argv);

#endif
