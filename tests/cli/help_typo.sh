for subject in grdi ruels biuld exitcodes frobnicate; do
  svdag help $subject 2>&1 || echo "exit $?"
done
