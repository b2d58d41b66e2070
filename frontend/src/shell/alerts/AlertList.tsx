/** The list behind the bell: what is still to be looked at, what was seen, what is over. */
import { Button, SegmentedControl } from "@mantine/core";
import { BellOff } from "lucide-react";
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useDevices } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Alert } from "@/api/types";
import { useNow } from "@/design/useNow";
import { EmptyState } from "@/design/EmptyState";
import { LoadProblem } from "../LoadProblem";
import { AlertItem } from "./AlertItem";
import { inState, sortAlerts } from "./alerts";
import styles from "./alerts.module.css";
import { useAlerts, useMarkSeen, useOverAlerts } from "./useAlerts";

const STATES: readonly Alert["state"][] = ["open", "seen", "over"];

function Waiting() {
  const { t } = useTranslation();
  return (
    <p className={styles.waiting} role="status">
      {t("alerts.loading")}
    </p>
  );
}

interface RowsProps {
  slug: string;
  alerts: Alert[];
  onLeave: () => void;
  /** Called when the button that has the focus is about to go. */
  onSeen: () => void;
}

function Rows({ slug, alerts, onLeave, onSeen }: RowsProps) {
  const { t } = useTranslation();
  const now = useNow(10_000);
  const devices = useDevices(slug).data ?? [];
  const { role } = useAlerts(slug);
  const { one } = useMarkSeen(slug);
  const see = (id: number) => {
    one.mutate(id);
    onSeen();
  };
  return (
    <ul className={styles.rows} aria-label={t("alerts.title")}>
      {alerts.map((alert) => (
        <AlertItem
          key={alert.id}
          slug={slug}
          alert={alert}
          device={devices.find((device) => device.id === alert.device)}
          now={now}
          busy={one.isPending}
          onLeave={onLeave}
          onSeen={!mayOperate(role) ? undefined : () => see(alert.id)}
        />
      ))}
    </ul>
  );
}

function Head({ slug, count }: { slug: string; count: number }) {
  const { t } = useTranslation();
  const { role } = useAlerts(slug);
  const { every } = useMarkSeen(slug);
  return (
    <div className={styles.head}>
      <h2>{t("alerts.title")}</h2>
      {!mayOperate(role) ? null : (
        <Button
          size="compact-sm"
          variant="subtle"
          disabled={count === 0}
          loading={every.isPending}
          onClick={() => every.mutate()}
        >
          {t("alerts.allSeen")}
        </Button>
      )}
    </div>
  );
}

export function AlertList({ slug, onLeave }: { slug: string; onLeave: () => void }) {
  const { t } = useTranslation();
  const [state, setState] = useState<Alert["state"]>("open");
  const box = useRef<HTMLDivElement>(null);
  const { alerts, query } = useAlerts(slug);
  const over = useOverAlerts(slug, state === "over");
  const asked = state === "over" ? over : query;
  const shown = state === "over" ? (over.data ?? []) : sortAlerts(inState(alerts, state));
  const label = (each: Alert["state"]) =>
    each === "over" ? t("alerts.state.over") : `${t(`alerts.state.${each}`)} ${inState(alerts, each).length}`;
  return (
    <>
      <Head slug={slug} count={inState(alerts, "open").length} />
      <SegmentedControl
        fullWidth
        size="xs"
        aria-label={t("alerts.filter")}
        value={state}
        onChange={(value) => setState(value)}
        data={STATES.map((each) => ({ value: each, label: label(each) }))}
      />
      <div className={styles.scroll} ref={box} tabIndex={-1}>
        {asked.error ? <LoadProblem error={asked.error} again={() => void asked.refetch()} /> : null}
        {asked.isPending ? <Waiting /> : null}
        {asked.data && shown.length === 0 ? (
          <EmptyState
            icon={<BellOff size={18} />}
            title={t(`alerts.none.${state}`)}
            text={state === "open" ? t("alerts.noneText") : undefined}
          />
        ) : null}
        {asked.data && shown.length > 0 ? (
          <Rows slug={slug} alerts={shown} onLeave={onLeave} onSeen={() => box.current?.focus()} />
        ) : null}
      </div>
    </>
  );
}
