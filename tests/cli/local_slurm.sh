#!/usr/bin/env bash
# local_slurm.sh start FOLDER [NODES]  a Slurm of its own on this machine, with several virtual nodes of one CPU each
# local_slurm.sh stop FOLDER           and its end
# Afterwards SLURM_CONF=FOLDER/slurm.conf is what sbatch and its like need. Ends with 77 where Slurm cannot start.
# From Debian's packages slurmctld, slurmd, slurm-client and munge; needs no systemd, no cgroups and no accounting.
set -euo pipefail
command=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
nodes=${3:-4}
export SLURM_CONF=$folder/slurm.conf PATH=$PATH:/usr/sbin

if [ "$command" = stop ]; then
  timeout 10 scancel --user="$(id -un)" 2>/dev/null || true
  for file in "$folder"/slurmd.*.pid "$folder/slurmctld.pid" "$folder/munge/pid"; do
    [ -s "$file" ] && kill "$(cat "$file")" 2>/dev/null || true
  done
  for _ in $(seq 100); do ls "$folder"/slurm*.pid >/dev/null 2>&1 || break; sleep 0.1; done
  exit 0
fi

for program in munged slurmctld slurmd sbatch; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not there (packages slurmctld slurmd slurm-client munge)"; exit 77; }
done
host=$(hostname -s)
port=$((20000 + $$ % 500 * 20))  # two tests at once must not meet
mkdir -p "$folder"/{munge,state,log}
chmod 755 "$folder" "$folder/munge"  # munged refuses a socket that others cannot reach
head -c 1024 /dev/urandom >"$folder/munge/key"
chmod 600 "$folder/munge/key"
# Read even where no process is tracked by cgroups.
printf 'CgroupPlugin=cgroup/v1\nCgroupAutomount=no\nConstrainCores=no\nConstrainRAMSpace=no\n' >"$folder/cgroup.conf"
cat >"$SLURM_CONF" <<END
ClusterName=mimik
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=2
SlurmdTimeout=60
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool.%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmctldLogFile=$folder/log/slurmctld.txt
SlurmdLogFile=$folder/log/slurmd.%n.txt
NodeName=n[1-$nodes] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + nodes))] CPUs=1 RealMemory=512 State=UNKNOWN
PartitionName=all Nodes=n[1-$nodes] Default=YES MaxTime=INFINITE State=UP
END
ready=
munged --key-file="$folder/munge/key" --socket="$folder/munge/socket" --pid-file="$folder/munge/pid" \
  --log-file="$folder/log/munged.txt" --seed-file="$folder/munge/seed" &&
  slurmctld -f "$SLURM_CONF" && ready=yes
for k in $(seq "$nodes"); do
  mkdir -p "$folder/spool.n$k"
  [ -z "$ready" ] || slurmd -N "n$k" -f "$SLURM_CONF" || ready=
done
for _ in $(seq 200); do
  [ "$ready" = yes ] || break
  state=$(timeout 5 sinfo --noheader --format=%T 2>/dev/null || true)
  [ "$state" != idle ] || exit 0
  sleep 0.1
done
"$0" stop "$folder"
echo "skipped: Slurm does not start here; see $folder/log"
exit 77
