for subject in check mesh diff vdb trace render report; do
  svdag-verify help $subject >of_help
  svdag-verify $subject --help >of_option
  cmp of_help of_option && head -n 1 of_help
done
svdag-verify help mehs 2>&1 || echo "exit $?"
svdag biuld --help 2>&1 || echo "exit $?"
