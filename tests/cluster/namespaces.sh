#!/bin/bash
# namespaces.sh - osgraytrace --mpi on hosts that are network namespaces of this machine, with lines of limited rate.
# SPDX-License-Identifier: MIT
# It compares the files of three hosts with those of one process, and measures how soon the job is over once a rank is
# killed, or all that one host has of the job. Nothing of the machine's own network is touched, or left behind. With
# EFFICIENCY_SECONDS=60 it measures with efficiency.py, too; MPIRUN_OPTIONS are more words for mpirun.
# Usage: namespaces.sh OSGRAYTRACE MODEL [MBIT_PER_SECOND]; it needs root, iproute2 and Open MPI, or says so and ends with 77.
set -u
skip() { echo "$1: skipped"; exit 77; }
program=$1 model=$2 rate=${3:-1000}
hosts=(n1 n2 n3)
name=$(basename "$program" | cut -c1-15)
here=$(cd "$(dirname "$0")" && pwd)

if [ -z "${INSIDE_NAMESPACES:-}" ]; then
    [ "$(id -u)" = 0 ] || skip "namespaces need root"
    for tool in ip tc unshare mpirun; do command -v $tool > /dev/null || skip "$tool is not there"; done
    mpirun --version | grep -q "Open MPI" || skip "mpirun is not Open MPI's"
    unshare -m -n true 2> /dev/null || skip "this machine allows no namespaces"
    # A process namespace ends all that is in it with its first process.
    INSIDE_NAMESPACES=1 exec unshare -m -n -p -f --mount-proc "$0" "$@"
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mount --make-rprivate / && mkdir -p /run/netns && mount -t tmpfs tmpfs /run/netns || skip "no mounts"
echo "127.0.0.1 localhost" > "$folder/names"
ip link set lo up
ip link add bridge0 type bridge 2> /dev/null || skip "the kernel has no bridges"
ip addr add 10.77.0.100/24 dev bridge0
ip link set bridge0 up
for i in 1 2 3; do
    ip netns add n$i
    ip link add line$i type veth peer name eth0 netns n$i || skip "the kernel has no veth"
    ip link set line$i master bridge0 up
    ip -n n$i addr add 10.77.0.$i/24 dev eth0
    ip -n n$i link set lo up
    ip -n n$i link set eth0 up
    tc qdisc add dev line$i root tbf rate "${rate}mbit" burst 256kb latency 50ms || skip "the kernel has no tbf"
    ip netns exec n$i tc qdisc add dev eth0 root tbf rate "${rate}mbit" burst 256kb latency 50ms
    echo "10.77.0.$i n$i" >> "$folder/names"
done
echo "10.77.0.100 $(hostname)" >> "$folder/names"
mount --bind "$folder/names" /etc/hosts
cat > "$folder/agent" << 'END'
#!/bin/sh
host=$1
shift
exec ip netns exec "$host" unshare -u sh -c "hostname $host; $*"
END
chmod +x "$folder/agent"

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
launch=(mpirun --host n1,n2,n3 --map-by node --bind-to none --mca plm_rsh_agent "$folder/agent" ${MPIRUN_OPTIONS:-}
    --mca oob_tcp_if_include 10.77.0.0/24 --mca btl_tcp_if_include 10.77.0.0/24)
picture=(--size 160 120 --light-samples 1 --integrator path --threads 1)
failed=0
check() { if [ "$2" = "$3" ]; then echo "$1: yes"; else echo "$1: NO"; failed=1; fi; }

cd "$folder" || exit 1
"$program" "$model" "${picture[@]}" --passes 60 --checkpoint one.exr > /dev/null || exit 1
for more in "" --send-scene; do
    "${launch[@]}" "$program" "$model" "${picture[@]}" --passes 60 --checkpoint all.exr --mpi $more || failed=1
    check "three hosts $more make the bits of one process" "$(sha256sum < all.exr)" "$(sha256sum < one.exr)"
    rm -f all.exr
done

# Returns the processes of a host by their name.
on() { ip netns pids "$1" | while read -r pid; do grep -q "^$2" "/proc/$pid/comm" && echo "$pid"; done; }

# A job that would last for hours; it is over once mpirun is.
kill_in_job()
{
    rm -f all.exr
    "${launch[@]}" "$program" "$model" "${picture[@]}" --passes 4000000 --interval 0.2 --checkpoint all.exr --mpi \
        2> errors > /dev/null &
    local job=$! begin pids
    for ((i = 0; i < 600; ++i)); do [ -e all.exr ] && break; sleep 0.1; done
    pids=$(for process in $2; do on n2 "$process"; done)
    [ -n "$pids" ] || { echo "$1: there is nothing to kill"; kill -9 $job; failed=1; return; }
    begin=$(date +%s.%N)
    # shellcheck disable=SC2086
    kill -9 $pids
    wait $job
    local code=$?
    echo "$1: mpirun ends with $code after $(awk "BEGIN { print $(date +%s.%N) - $begin }") s"
    [ $code != 0 ] || failed=1
    for ((i = 0; i < 100; ++i)); do
        left=$(for host in "${hosts[@]}"; do on $host "$name"; done)
        [ -z "$left" ] && break
        sleep 0.1
    done
    echo "$1: no rank is left after $(awk "BEGIN { print $(date +%s.%N) - $begin }") s"
    check "$1: all ranks have ended" "$left" ""
}
kill_in_job "a killed rank" "$name"
kill_in_job "a killed host" "$name orted"

if [ -n "${EFFICIENCY_SECONDS:-}" ]; then
    "$here/efficiency.py" "$program" "$model" "$EFFICIENCY_SECONDS" 2 3 "${launch[@]}" || failed=1
fi
exit $failed
