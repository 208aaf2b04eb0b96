# shellcheck shell=sh
# Sourced: a Slurm cluster of this machine alone, of two nodes with one core each, for whoever starts it.
#
# start_cluster FOLDER: 77 where Slurm is not installed; else it runs, with its files in the folder and $SLURM_CONF set.
# stop_cluster: ends what was started.

CLUSTER=

start_cluster() {
  PATH=$PATH:/usr/sbin
  for program in munged slurmctld slurmd sbatch; do command -v $program >/dev/null || return 77; done
  mkdir -p "$1/state" "$1/node1" "$1/node2"
  chmod 755 "$1"
  cluster_folder=$(cd "$1" && pwd)
  port=$((20000 + $$ % 10000 * 3))
  SLURM_CONF=$cluster_folder/slurm.conf
  export SLURM_CONF
  cat >"$SLURM_CONF" <<END
ClusterName=kaboum
SlurmctldHost=localhost
SlurmctldPort=$port
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$cluster_folder/munge.socket
StateSaveLocation=$cluster_folder/state
SlurmdSpoolDir=$cluster_folder/%n
SlurmctldPidFile=$cluster_folder/slurmctld.pid
SlurmdPidFile=$cluster_folder/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0
MinJobAge=300
NodeName=node1,node2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 1)),$((port + 2)) CPUs=1 State=UNKNOWN
PartitionName=all Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
END
  head -c 128 /dev/urandom >"$cluster_folder/munge.key"
  chmod 400 "$cluster_folder/munge.key"
  munged --foreground --force --key-file="$cluster_folder/munge.key" --socket="$cluster_folder/munge.socket" \
    --pid-file="$cluster_folder/munge.pid" --log-file="$cluster_folder/munge.log" --seed-file="$cluster_folder/munge.seed" \
    >"$cluster_folder/munged.txt" 2>&1 &
  CLUSTER=$!
  wait_for test -S "$cluster_folder/munge.socket" || return 1
  slurmctld -D >"$cluster_folder/slurmctld.txt" 2>&1 &
  CLUSTER="$! $CLUSTER"
  for node in node1 node2; do
    slurmd -D -N $node >"$cluster_folder/$node.txt" 2>&1 &
    CLUSTER="$! $CLUSTER"
  done
  wait_for nodes_are_idle || return 1
}

# wait_for COMMAND...: until it succeeds, or for half a minute.
wait_for() {
  tries=0
  until "$@"; do
    tries=$((tries + 1))
    [ $tries -lt 300 ] || return 1
    sleep 0.1
  done
}

nodes_are_idle() { [ "$(sinfo -h -o '%D %t' 2>/dev/null)" = '2 idle' ]; }

stop_cluster() {
  for process in $CLUSTER; do
    kill "$process" 2>/dev/null
    wait "$process" 2>/dev/null
  done
  CLUSTER=
}
