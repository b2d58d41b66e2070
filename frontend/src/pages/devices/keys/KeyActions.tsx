/** An admin's decisions about a device that takes part: a new key, no key any more, retirement. */
import { Button, Menu, Modal } from "@mantine/core";
import { Ban, KeyRound, PowerOff } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import type { Device, Site } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { useDecide } from "../decisions";
import styles from "./keys.module.css";

export type KeyDecision = "rotate" | "revoke" | "retire";

const WORDS = { rotate: "newKey", revoke: "revoke", retire: "retire" } as const;
const ICONS = { rotate: KeyRound, revoke: Ban, retire: PowerOff };

export function KeyMenuItems({ device, choose }: { device: Device; choose: (decision: KeyDecision) => void }) {
  const { t } = useTranslation();
  if (device.lifecycle !== "approved") return null;
  const offered: KeyDecision[] = device.has_key ? ["rotate", "revoke", "retire"] : ["rotate", "retire"];
  return offered.map((decision) => {
    const Icon = ICONS[decision];
    return (
      <Menu.Item key={decision} leftSection={<Icon size={15} />} onClick={() => choose(decision)}>
        {t(`keys.${WORDS[decision]}`)}
      </Menu.Item>
    );
  });
}

interface AskProps {
  site: Site;
  device: Device;
  decision: KeyDecision;
  onClose: () => void;
}

export function AskKeyDecision({ site, device, decision, onClose }: AskProps) {
  const { t } = useTranslation();
  useReturnFocus();
  const navigate = useNavigate();
  const decide = useDecide(site.slug);
  const word = WORDS[decision];
  const leave = () => {
    onClose();
    if (decision === "retire") void navigate(`/sites/${site.slug}/devices`);
  };
  return (
    <Modal opened onClose={onClose} title={t(`keys.${word}Ask`, { name: device.name })} size={440}>
      <p>{t(`keys.${word}Text`)}</p>
      <div className={styles.ask}>
        <Button variant="default" onClick={onClose} data-autofocus>
          {t("keys.cancel")}
        </Button>
        <Button
          color={decision === "rotate" ? undefined : "red.9"}
          loading={decide.isPending}
          onClick={() => decide.mutate({ do: decision, device }, { onSuccess: leave })}
        >
          {t(`keys.${word}`)}
        </Button>
      </div>
    </Modal>
  );
}

/** What an admin should know about a device's messages and key; nothing when all is well. */
export function KeyTrouble({ device }: { device: Device }) {
  const { t } = useTranslation();
  const lines = [
    device.lifecycle === "approved" && !device.has_key ? t("keys.noKey") : "",
    device.dropped > 0 ? t("keys.dropped", { count: device.dropped }) : "",
  ].filter(Boolean);
  return lines.map((line) => (
    <p key={line} className={styles.trouble}>
      {line}
    </p>
  ));
}
