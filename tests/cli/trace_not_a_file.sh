# A folder or a pipe is no DAG; nobody waits for what it might say.
mkdir folder
mkfifo pipe
for name in folder folder/ pipe none.svdag; do
  svdag-trace $name || echo "exit $?"
done
