/** A topic outside of VIPO's own that a device asks for, or has: what it means, and an admin's decision. */
import { Button, Modal } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Device, Site } from "@/api/types";
import { StatusBadge } from "@/design/StatusBadge";
import { useReturnFocus } from "@/design/useReturnFocus";
import { useDecide } from "../decisions";
import styles from "../keys/keys.module.css";

const OWN = "vipo/";

interface Props {
  site: Site;
  device: Device;
  topic: string;
  /** Whether nobody has confirmed it yet. */
  asking: boolean;
}

export function LegacyTopic({ site, device, topic, asking }: Props) {
  const { t } = useTranslation();
  const [deciding, setDeciding] = useState(false);
  if (topic.startsWith(OWN)) return null;
  const word = asking ? "confirm" : "withdraw";
  const mayDecide = site.role === "admin" && device.lifecycle === "approved";
  return (
    <div className={styles.legacy}>
      <StatusBadge status={asking ? "pending" : "done"}>
        {t(`device.topic.${asking ? "asked" : "confirmed"}`)}
      </StatusBadge>
      {mayDecide ? (
        <Button
          size="compact-sm"
          variant="default"
          aria-label={t(`device.topic.${word}Of`, { topic })}
          onClick={() => setDeciding(true)}
        >
          {t(`device.topic.${word}`)}
        </Button>
      ) : null}
      {deciding ? (
        <AskTopic site={site} device={device} topic={topic} asking={asking} onClose={() => setDeciding(false)} />
      ) : null}
    </div>
  );
}

function AskTopic({ site, device, topic, asking, onClose }: Props & { onClose: () => void }) {
  useReturnFocus();
  const { t } = useTranslation();
  const decide = useDecide(site.slug);
  const word = asking ? "confirm" : "withdraw";
  const decision = { do: asking ? "confirmTopic" : "withdrawTopic", device, topic } as const;
  return (
    <Modal opened onClose={onClose} title={t(`device.topic.${word}Ask`)} size={480}>
      <p className={styles.asked}>
        <code>{topic}</code>
      </p>
      <p>{t(`device.topic.${word}Text`, { name: device.name })}</p>
      <div className={styles.ask}>
        <Button variant="default" onClick={onClose} data-autofocus>
          {t("keys.cancel")}
        </Button>
        <Button loading={decide.isPending} onClick={() => decide.mutate(decision, { onSuccess: onClose })}>
          {t(`device.topic.${word}`)}
        </Button>
      </div>
    </Modal>
  );
}
