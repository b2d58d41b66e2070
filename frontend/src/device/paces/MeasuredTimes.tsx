/** What a device takes for what it does, beside what its copy takes, and whether rehearsals use that. */
import { Button, Skeleton } from "@mantine/core";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { Check, TrendingDown, TrendingUp, Undo2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Device, MethodPace, Site } from "@/api/types";
import { formatMoment, formatNumber } from "@/i18n/format";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import { PaceStrip } from "./PaceStrip";
import styles from "./paces.module.css";
import { percentOver } from "./paces";

const NOTICED_M = 0.05;

interface OfDevice {
  site: Site;
  device: Device;
}

const pathOf = ({ site, device }: OfDevice) => `/sites/${site.slug}/devices/${device.id}/paces`;

export function MeasuredTimes(props: OfDevice) {
  const { t } = useTranslation();
  const { site, device } = props;
  const paces = useQuery({
    queryKey: keys.paces(site.slug, device.id),
    queryFn: () => api.get<MethodPace[]>(pathOf(props)),
  });
  return (
    <section className={styles.section} aria-labelledby="measured-times">
      <h3 id="measured-times">{t("device.paces.title")}</h3>
      <p className={styles.hint}>{t("device.paces.hint")}</p>
      {paces.isError ? <LoadProblem error={paces.error} again={() => void paces.refetch()} /> : null}
      {paces.isPending ? <Skeleton height={64} /> : null}
      {paces.data?.length === 0 ? <p className={styles.hint}>{t("device.paces.none")}</p> : null}
      <ul className={styles.list}>
        {paces.data?.map((pace) => (
          <Row key={pace.method} {...props} pace={pace} />
        ))}
      </ul>
    </section>
  );
}

/** How long something takes beside its model, in words. */
function usePaceWords() {
  const { t } = useTranslation();
  return (usual: number): string => {
    const percent = percentOver(usual);
    if (percent === 0) return t("device.paces.asModel");
    return t(percent > 0 ? "device.paces.longer" : "device.paces.shorter", {
      percent: formatNumber(Math.abs(percent)),
    });
  };
}

function Row(props: OfDevice & { pace: MethodPace }) {
  const { t } = useTranslation();
  const { site, pace } = props;
  const words = usePaceWords();
  return (
    <li className={styles.row}>
      <div className={styles.head}>
        <code>{pace.method}</code>
        {pace.usual === null ? null : <b>{words(pace.usual)}</b>}
        <PaceStrip pace={pace} />
      </div>
      <p className={styles.facts}>
        <span>{t("device.paces.measured", { times: formatNumber(pace.count) })}</span>
        {pace.apart_m === null || pace.apart_m < NOTICED_M ? null : (
          <span>{t("device.paces.apart", { metres: formatNumber(pace.apart_m, 1) })}</span>
        )}
        {pace.change ? <Change percent={pace.change.percent} /> : null}
      </p>
      {pace.calibrated ? <InUse taken={pace.calibrated} /> : null}
      {mayOperate(site.role) ? <Decision {...props} /> : null}
    </li>
  );
}

function Change({ percent }: { percent: number }) {
  const { t } = useTranslation();
  const Icon = percent > 0 ? TrendingUp : TrendingDown;
  return (
    <span className={styles.change}>
      <Icon size={14} aria-hidden="true" />
      {t(percent > 0 ? "device.paces.slower" : "device.paces.faster", { percent: formatNumber(Math.abs(percent)) })}
    </span>
  );
}

function InUse({ taken }: { taken: NonNullable<MethodPace["calibrated"]> }) {
  const { t } = useTranslation();
  const facts = { pace: formatNumber(taken.pace, 2), at: formatMoment(taken.at), by: taken.by };
  return (
    <p className={styles.inUse}>
      <Check size={14} aria-hidden="true" />
      <span>{t(taken.by ? "device.paces.inUse" : "device.paces.inUseSomebody", facts)}</span>
    </p>
  );
}

function Decision(props: OfDevice & { pace: MethodPace }) {
  const { t } = useTranslation();
  const { site, device, pace } = props;
  const queries = useQueryClient();
  const path = `${pathOf(props)}/${encodeURIComponent(pace.method)}`;
  const decide = useMutation({
    mutationFn: (take: boolean) => (take ? api.put<MethodPace>(path, {}) : api.delete<MethodPace>(path)),
    onError: useTellUnseen(),
    onSettled: () => queries.invalidateQueries({ queryKey: keys.paces(site.slug, device.id) }),
  });
  if (!pace.can_be_taken && !pace.calibrated) return null;
  return (
    <div className={styles.decision}>
      {pace.can_be_taken ? (
        <Button
          size="compact-sm"
          variant="default"
          loading={decide.isPending}
          aria-label={t("device.paces.useOf", { method: pace.method })}
          onClick={() => decide.mutate(true)}
        >
          {t("device.paces.use")}
        </Button>
      ) : null}
      {pace.calibrated ? (
        <Button
          size="compact-sm"
          variant="subtle"
          loading={decide.isPending}
          leftSection={<Undo2 size={13} aria-hidden="true" />}
          aria-label={t("device.paces.dropOf", { method: pace.method })}
          onClick={() => decide.mutate(false)}
        >
          {t("device.paces.drop")}
        </Button>
      ) : null}
      {decide.isError ? <p role="alert">{problemText(decide.error, t("shell.problem.screen"))}</p> : null}
    </div>
  );
}
