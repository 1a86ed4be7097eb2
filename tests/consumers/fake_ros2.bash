#!/usr/bin/env bash
# Answers as the command-line tools of ROS 2 do, from files in $STATE: one a controller or node, with its state in it.
# What changes a state is written to $STATE/log. Formats: ros2controlcli, ros2lifecycle, tf2_ros, ros2param.
case "$1 $2" in
  "node list") ls "$STATE/nodes" | sed 's,^,/,' ;;
  "lifecycle get") # --no-daemon NODE
    [ -e "$STATE/nodes$4" ] || { echo "Node not found" >&2; exit 1; }
    echo "$(cat "$STATE/nodes$4") [2]"
    ;;
  "lifecycle set") # --no-daemon --spin-time S NODE TRANSITION; a transition that fails ends with 0 too
    echo "$7 $6" >> "$STATE/log"
    [ -e "$STATE/refuses$6" ] && { echo "Transitioning failed" >&2; exit 0; }
    [ "$7" = configure ] && echo inactive > "$STATE/nodes$6" || echo active > "$STATE/nodes$6"
    ;;
  "control list_controllers")
    for file in "$STATE"/controllers/*; do
      printf '\033[92m%-20s\033[0m %s  \033[92m%-8s\033[0m\n' "$(basename "$file")" a_package/AType "$(cat "$file")"
    done
    ;;
  "control switch_controllers") # --activate NAME... --strict -c MANAGER
    shift 3
    while [ "$1" != --strict ]; do
      echo "claim $1" >> "$STATE/log"
      echo active > "$STATE/controllers/$1"
      shift
    done
    ;;
  "topic echo" | "run tf2_ros") # both come from joint states
    grep -qx active "$STATE/controllers/joint_states" 2> /dev/null || exit 1
    echo "At time 1.0"
    echo "- Translation: [0.000, 0.000, 0.000]"
    ;;
  "action list") cat "$STATE/actions" ;;
  "param get") cat "$STATE/description$4" ;; # --no-daemon NODE NAME
  *) exit 64 ;;
esac
