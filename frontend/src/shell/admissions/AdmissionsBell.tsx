/** How many robots of the site wait to be let into a zone, with them behind it; a new one is told as a toast. */
import { Popover } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { Bot } from "lucide-react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { useAwaitedAdmissions } from "@/api/admissions";
import { useSite } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { AwaitedAdmission } from "@/api/types";
import styles from "../questions/questions.module.css";
import { AdmissionCard } from "./AdmissionCard";

/** What this browser has shown as a toast and what still waits, for all pages of the visit. */
const toasted = new Set<string>();
const keyOf = ({ zone, robot }: AwaitedAdmission) => `let-in/${zone}/${robot}`;

function useToasts(awaited: readonly AwaitedAdmission[], allowed: boolean): void {
  const { t } = useTranslation();
  useEffect(() => {
    const waiting = new Set(awaited.map(keyOf));
    for (const gone of [...toasted].filter((key) => !waiting.has(key))) {
      notifications.hide(gone);
      toasted.delete(gone);
    }
    for (const each of awaited) {
      const id = keyOf(each);
      if (!allowed || toasted.has(id)) continue;
      toasted.add(id);
      const message = t("admission.text", { robot: each.robot_name, zone: each.zone_name });
      notifications.show({ id, title: t("admission.title"), message, color: "yellow", autoClose: 12_000 });
    }
  }, [awaited, allowed, t]);
}

export function AdmissionsBell({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const allowed = mayOperate(useSite(slug).data?.role);
  const awaited = useAwaitedAdmissions(slug);
  useToasts(awaited, allowed);
  // A card's menu lies beside the list: without this a press on it closed the list, and the menu before it was heard.
  const [isMenuOpen, setMenuOpen] = useState(false);
  if (awaited.length === 0) return null;
  return (
    <Popover position="bottom-end" width={340} shadow="md" withinPortal trapFocus closeOnClickOutside={!isMenuOpen}>
      <Popover.Target>
        <button type="button" className={styles.bell} aria-label={t("admission.open", { count: awaited.length })}>
          <Bot size={17} aria-hidden /> <b>{awaited.length}</b>
        </button>
      </Popover.Target>
      <Popover.Dropdown className={styles.list}>
        {awaited.map((each) => (
          <AdmissionCard key={keyOf(each)} slug={slug} awaited={each} allowed={allowed} leads onMenu={setMenuOpen} />
        ))}
      </Popover.Dropdown>
    </Popover>
  );
}
