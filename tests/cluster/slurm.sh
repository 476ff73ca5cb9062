# A Slurm of two nodes on this machine, from Debian's packages, without systemd. Sourced by run.sh, which sets $work.
# Each node has one CPU. Needs root, because munge and slurmd want it.

start_slurm() {
    local host
    host=$(hostname -s)
    install -d -o munge -g munge /run/munge
    if [ ! -s /etc/munge/munge.key ]; then
        dd if=/dev/urandom of=/etc/munge/munge.key bs=1024 count=1 status=none
        chown munge: /etc/munge/munge.key
        chmod 400 /etc/munge/munge.key
    fi
    mkdir -p "$work/slurm/state" "$work/slurm/spool"
    cat >"$work/slurm/slurm.conf" <<CONF
ClusterName=pinhole
SlurmctldHost=$host
SlurmctldPort=$((base_port))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
ReturnToService=2
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
JobRequeue=1
SchedulerParameters=bf_interval=1,sched_interval=1,requeue_delay=1
MinJobAge=300
KillWait=1
StateSaveLocation=$work/slurm/state
SlurmdSpoolDir=$work/slurm/spool/%n
SlurmctldPidFile=$work/slurm/slurmctld.pid
SlurmdPidFile=$work/slurm/slurmd-%n.pid
SlurmctldLogFile=$work/slurm/slurmctld.log
SlurmdLogFile=$work/slurm/slurmd-%n.log
NodeName=n[1-2] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((base_port + 1))-$((base_port + 2))] CPUs=1 RealMemory=2000
PartitionName=main Nodes=ALL Default=YES State=UP
CONF
    export SLURM_CONF=$work/slurm/slurm.conf
    if ! munge -n >/dev/null 2>&1; then
        runuser -u munge -- munged
        started_munge=yes
    fi
    slurmctld -D >"$work/slurm/slurmctld.out" 2>&1 &
    pids+=($!)
    for node in n1 n2; do
        slurmd -D -N "$node" >"$work/slurm/$node.out" 2>&1 &
        pids+=($!)
    done
    for _ in $(seq 150); do
        [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ] && [ "$(sinfo -h -o %D)" = 2 ] && return
        sleep 0.2
    done
    echo "Slurm did not start:" >&2
    tail -n 5 "$work"/slurm/*.out "$work"/slurm/*.log >&2
    return 1
}

# Waits until no job of this user is in the queue. Jobs whose dependency cannot be satisfied leave it by themselves.
wait_for_slurm() {
    local end=$((SECONDS + $1))
    while [ -n "$(squeue --noheader)" ]; do
        if [ "$SECONDS" -ge "$end" ]; then
            squeue >&2
            echo "jobs did not end within $1 s" >&2
            return 1
        fi
        sleep 0.5
    done
}
