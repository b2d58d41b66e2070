import { Skeleton } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Cpu } from "lucide-react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { DeviceEvent, FieldChange } from "@/api/types";
import { LoadProblem } from "@/shell/LoadProblem";
import { Avatar } from "@/design/Avatar";
import { Panel } from "@/design/Panel";
import { deviceEventWords } from "@/i18n/deviceEvents";
import { formatMoment } from "@/i18n/format";
import styles from "./history.module.css";

/** How a field was and is; one that came or went has only one of the two. */
function Field({ change }: { change: FieldChange }) {
  return (
    <div className={styles.difference}>
      <code>{change.path}</code>
      {change.before ? <del>{change.before}</del> : null}
      {change.after ? <ins>{change.after}</ins> : null}
    </div>
  );
}

function Fields({ changes }: { changes: readonly FieldChange[] }) {
  const { t } = useTranslation();
  return (
    <details>
      <summary>{t("pages.devices.fieldChanges", { count: changes.length })}</summary>
      {changes.map((change) => (
        <Field key={change.path} change={change} />
      ))}
    </details>
  );
}

function Change({ event }: { event: DeviceEvent }) {
  return (
    <li>
      {event.by ? (
        <Avatar name={event.by} size={22} title={event.by} />
      ) : (
        <span className={styles.machineSign}>
          <Cpu size={13} aria-hidden="true" />
        </span>
      )}
      <span>
        {event.by ? <b>{event.by} </b> : null}
        {deviceEventWords(event)}
        <small>{formatMoment(event.at)}</small>
        {event.changes.length > 0 ? <Fields changes={event.changes} /> : null}
      </span>
    </li>
  );
}

/** What happened to a device, newest first. */
export function DeviceHistory({ slug, device, most }: { slug: string; device: string; most: number }) {
  const { t } = useTranslation();
  const path = `/sites/${slug}/devices/${encodeURIComponent(device)}/events?limit=${most}`;
  const events = useQuery({
    queryKey: [...keys.deviceEvents(slug, device), most],
    queryFn: () => api.get<DeviceEvent[]>(path),
  });
  return (
    <Panel className={styles.changes}>
      <div className={styles.cardHead}>
        <h3>{t("pages.devices.changes")}</h3>
      </div>
      {events.isPending ? <Skeleton height={120} m={12} w="auto" /> : null}
      {events.isLoadingError ? <LoadProblem error={events.error} again={() => void events.refetch()} /> : null}
      <ul>
        {events.data?.map((event, index) => (
          <Change key={index} event={event} />
        ))}
      </ul>
      {events.data?.length === 0 ? <p className={styles.none}>{t("pages.devices.noChanges")}</p> : null}
    </Panel>
  );
}
