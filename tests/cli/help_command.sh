# The same as --help, also for commands that are separate programs.
for command in build merge plan run submit info export import help; do
  svdag help $command >of_help
  svdag $command --help >of_option
  cmp of_help of_option && echo "$command: $(wc -l <of_help | awk '{ print ($1 > 8 ? "complete" : "too short") }')"
done
