"""What a symptom or a log line may mean, and which read-only observation rules each cause out."""
