limit_s="${CELL_WAIT_S:-60}" # how long a step waits for one condition

# Whether one condition holds now. Every command reads, and none asks a daemon of another domain.
holds() {
  case "$1" in
    node) ros2 node list --no-daemon | grep -Fqx -- "$2" ;;
    lifecycle) ros2 lifecycle get --no-daemon "$2" | grep -q -- "^$3 " ;;
    controller)
      ros2 control list_controllers -c "$2" | sed 's/\x1b\[[0-9;]*m//g' |
        grep -Eq -- "^$3(\[[^]]*\])?[[:space:]].*[[:space:]]$4[[:space:]]*$"
      ;;
    topic) timeout 5 ros2 topic echo --no-daemon --once "$2" > /dev/null ;;
    action) ros2 action list | grep -Fqx -- "$2" ;;
    transform) timeout 5 ros2 run tf2_ros tf2_echo "$2" "$3" | grep -q -m 1 -- "- Translation:" ;;
    mocked) [ "$(plugins "$2")" = "<plugin>mock_components/GenericSystem" ] ;;
    *) return 1 ;;
  esac
}

# The hardware plugins of the description that a manager runs, whatever a launch argument says.
plugins() {
  ros2 param get --no-daemon "$1" robot_description | grep -o "<plugin>[^<]*" | sort -u
}

# Waits until a condition holds; a bring-up that has no proof of it stops here.
needs() {
  local until_s=$((SECONDS + limit_s))
  echo "$step waits for $*"
  until ROS_SECURITY_ENCLAVE_OVERRIDE="$enclave" holds "$@" 2> /dev/null; do
    if [ "$SECONDS" -ge "$until_s" ]; then
      echo "$step stops: after $limit_s s there is no $*" >&2
      exit 1
    fi
    sleep 1
  done
}

# Does the step; what the command itself reports decides whether launching shows it as failed.
act() {
  echo "$step: $*"
  ROS_SECURITY_ENCLAVE_OVERRIDE="$enclave" exec "$@"
}
